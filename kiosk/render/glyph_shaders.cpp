#include "kiosk/render/glyph_shaders.h"

namespace prismesh::kiosk::render {

// Projects the shell's corners to pixels and covers them with two triangles, in which the fragment shader draws the glyph. A shell smaller
// than min_pixels is scaled up about its middle. Depth is that of the corner nearest to the eye.
const char* const kGlyphVertex = R"(
layout(location = 0) in uvec2 glyph;
uniform usampler2D connectivity;
uniform mat2 clip_from_pixels, pixels_from_clip;
uniform float min_pixels;
uniform float mm_per_pixel;
uniform int needed_level;
out vec2 at;
flat out vec4 ab, cd, mark;
flat out vec2 before, middle;
flat out float reach;
flat out uint glyph_kind;
const float kRim = 9.0;
void main() {
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  at = before = middle = vec2(0.0);
  ab = cd = mark = vec4(0.0);
  reach = 1.0;
  glyph_kind = glyph.y;
  if (int(glyph.y >> 8) < needed_level) return;
  uvec4 nodes = texelFetch(connectivity, texel(glyph.x), 0);
  int count = nodes.z == nodes.w ? 3 : 4, k = int(glyph.y >> 5) & 3;
  vec4 place[4] = vec4[4](texelFetch(positions, texel(nodes.x), 0), texelFetch(positions, texel(nodes.y), 0),
                          texelFetch(positions, texel(nodes.z), 0), texelFetch(positions, texel(nodes.w), 0));
  cut(0.25 * (place[0].xyz + place[1].xyz + place[2].xyz + place[3].xyz));
  vec2 seen[4];
  float nearest = 1e30;
  for (int i = 0; i < 4; ++i) {
    vec4 clip = clip_from_model * vec4(place[i].xyz, 1.0);
    if (place[i].w == 0.0 || clip.w <= 0.0) return;
    seen[i] = pixels_from_clip * (clip.xy / clip.w);
    nearest = min(nearest, clip.w);
  }
  int next = (k + 1) % count, last = (k + count - 1) % count;
  uint kind = glyph.y & 15u;
  vec2 other = seen[next];
  if (kind == 0u) other = seen[(k + 2) % 4];
  if (kind == 1u && count == 3) {  // a triangle's height: from the corner to its foot on the opposite edge
    vec3 side = place[last].xyz - place[next].xyz;
    float share = clamp(dot(place[k].xyz - place[next].xyz, side) / max(dot(side, side), 1e-30), 0.0, 1.0);
    vec4 clip = clip_from_model * vec4(place[next].xyz + share * side, 1.0);
    other = pixels_from_clip * (clip.xy / clip.w);
  }
  middle = count == 3 ? (seen[0] + seen[1] + seen[2]) / 3.0 : 0.25 * (seen[0] + seen[1] + seen[2] + seen[3]);
  if (kind == 6u) middle = seen[k];
  for (int i = 0; i < 4; ++i) reach = max(reach, distance(seen[i], middle));
  float grow = max(1.0, min_pixels / reach);
  reach = kind == 6u ? min_pixels : reach * grow;
  for (int i = 0; i < 4; ++i) seen[i] = middle + (seen[i] - middle) * grow;
  other = middle + (other - middle) * grow;
  ab = vec4(seen[0], seen[1]);
  cd = vec4(seen[2], seen[3]);
  mark = vec4(seen[k], other);
  before = seen[last];
  vec2 low = kind == 6u ? middle - reach : min(min(seen[0], seen[1]), min(seen[2], seen[3]));
  vec2 high = kind == 6u ? middle + reach : max(max(seen[0], seen[1]), max(seen[2], seen[3]));
  float rim = kRim + (kind == 15u ? 0.3 * reach : 0.0);
  at = mix(low - rim, high + rim, 0.5 + 0.5 * square_corner(gl_VertexID));
  float w = max(nearest - (grow > 1.0 ? min_pixels : 1.5) * mm_per_pixel - over_plates_mm, 0.001);
  gl_Position = vec4(clip_from_pixels * at, depth_terms.x - depth_terms.y / w, 1.0);
}
)";

// Draws a glyph from its signed distance in pixels (negative inside). Kinds are values of GlyphShape, or kMarkedGlyph.
const char* const kGlyphFragment = R"(
in vec2 at;
flat in vec4 ab, cd, mark;
flat in vec2 before, middle;
flat in float reach;
flat in uint glyph_kind;
uniform vec3 warn_ink, fail_ink, mark_ink;
out vec4 colour;
float segment(vec2 p, vec2 a, vec2 b) {
  vec2 along = b - a;
  return length(p - a - along * clamp(dot(p - a, along) / max(dot(along, along), 1e-6), 0.0, 1.0));
}
float outline(vec2 p, float share) {
  vec2 a = mix(middle, ab.xy, share), b = mix(middle, ab.zw, share), c = mix(middle, cd.xy, share), d = mix(middle, cd.zw, share);
  return min(min(segment(p, a, b), segment(p, b, c)), min(segment(p, c, d), segment(p, d, a)));
}
vec2 unit(vec2 v) { return v / max(length(v), 1e-6); }
float stop(vec2 p, vec2 end, vec2 across, float size) { return segment(p, end - across * size, end + across * size); }
float arrow(vec2 p, vec2 end, vec2 back, float size) {
  vec2 side = vec2(-back.y, back.x);
  return min(segment(p, end, end + size * (back + 0.6 * side)), segment(p, end, end + size * (back - 0.6 * side)));
}
// A point is inside the angle if the cosine of its direction to the bisector is at least that of the half angle.
float corner_glyph(vec2 p, uint kind, float w) {
  vec2 c = mark.xy, to_next = unit(mark.zw - c), to_last = unit(before - c);
  float legs = min(length(mark.zw - c), length(before - c));
  float r = clamp(0.42 * legs, 5.5, 22.0);
  vec2 half_way = unit(to_next + to_last + 1e-4 * unit(middle - c));
  float half_cosine = dot(half_way, to_next);
  if (dot(half_way, middle - c) < 0.0) {  // a reflex corner: use the other bisector
    half_way = -half_way;
    half_cosine = -half_cosine;
  }
  vec2 from = p - c;
  float d = length(from);
  bool inside = dot(unit(from), half_way) >= half_cosine;
  float sides = min(segment(p, c, c + to_next * r * 1.5), segment(p, c, c + to_last * r * 1.5)) - 0.9 * w;
  float rays = min(segment(p, c, c + to_next * r), segment(p, c, c + to_last * r));
  if (kind == 3u) return min(sides, inside ? max(d - r, -rays) : max(rays, d - r));
  float ends = min(distance(p, c + to_next * r), distance(p, c + to_last * r));
  return min(sides, (inside ? abs(d - r) : ends) - 1.7 * w);
}
float shape(vec2 p, uint kind) {
  float w = clamp(reach / 14.0, 0.65, 1.0);
  vec2 along = unit(mark.zw - mark.xy), across = vec2(-along.y, along.x);
  if (kind == 0u) return min(outline(p, 0.8) - 0.8 * w, segment(p, mark.xy, mark.zw) - 2.3 * w);
  if (kind == 1u) {
    float stops = min(stop(p, mark.xy, across, 5.0 * w), stop(p, mark.zw, across, 5.0 * w)) - 1.1 * w;
    return min(segment(p, mark.xy, mark.zw) - 2.1 * w, stops);
  }
  if (kind == 2u) {
    float heads = min(arrow(p, mark.xy, along, 6.0 * w), arrow(p, mark.zw, -along, 6.0 * w));
    return min(segment(p, mark.xy, mark.zw), heads) - 1.2 * w;
  }
  if (kind == 3u || kind == 4u) return corner_glyph(p, kind, w);
  if (kind == 5u) {
    vec2 q = abs(vec2(dot(p - middle, along), dot(p - middle, across)));
    float size = max(0.33 * distance(mark.xy, mark.zw), 6.0);
    vec2 d = q - vec2(size, max(0.22 * size, 2.6));
    return abs(length(max(d, 0.0)) + min(max(d.x, d.y), 0.0)) - 1.1 * w;
  }
  if (kind == 6u) {
    vec2 q = p - middle;
    float spokes = min(segment(q, vec2(0.0), vec2(0.0, reach)), min(segment(q, vec2(0.0), vec2(0.866, -0.5) * reach),
                                                                    segment(q, vec2(0.0), vec2(-0.866, -0.5) * reach)));
    return min(abs(length(q) - reach), spokes) - 1.1 * w;
  }
  if (kind == 7u) {
    vec2 q = abs(p - middle);
    float size = clamp(0.6 * reach, 5.0, 12.0);
    return segment(q, vec2(0.0), vec2(size)) - 2.0 * w;
  }
  if (kind == 15u) return min(outline(p, 1.22) - 1.5, outline(p, 1.22 + 4.0 / max(reach, 1.0)) - 0.5);
  return abs(distance(p, middle) - clamp(0.45 * reach, 4.5, 12.0)) - 1.6 * w;
}
void main() {
  uint kind = glyph_kind & 15u;
  bool failing = (glyph_kind & 16u) != 0u;
  float distance = shape(at, kind);
  float soft = max(fwidth(at.x), fwidth(at.y)) * 0.5;
  float body = 1.0 - smoothstep(-soft, soft, distance);
  float rim = 1.0 - smoothstep(-soft, soft, distance - 1.2);
  if (rim < 0.02) discard;
  vec3 ink = kind == 15u ? mark_ink : failing ? fail_ink : warn_ink;
  vec3 dark = kind == 15u ? vec3(0.03, 0.08, 0.2) : failing ? vec3(0.25, 0.02, 0.02) : vec3(0.20, 0.16, 0.02);
  colour = vec4(mix(dark, ink, body), rim);
}
)";

}  // namespace prismesh::kiosk::render
