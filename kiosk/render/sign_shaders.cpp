#include "kiosk/render/sign_shaders.h"

namespace prismesh::kiosk::render::sign_shaders {

const char* const kSquareCorner = R"(
vec2 square_corner(int vertex) {
  int k = vertex % 6;
  return vec2(k == 1 || k == 2 || k == 4 ? 1.0 : -1.0, k == 2 || k == 4 || k == 5 ? 1.0 : -1.0);
}
)";

// Octahedra, or where those would be a few pixels small, squares on their corner. Indices of nodes stand in rows, one a chunk;
// `first` is the row's first place. The offsets are in screen space, so each eye sees the same solid from where it is.
const char* const kNodeVertex = R"(
uniform usampler2D selection;
uniform int first;
uniform mat4 screen_from_model, clip_from_screen;
uniform mat3 screen_from_normal;
uniform float radius_pixels, mm_per_pixel, viewer_mm, grow;
out vec3 place;
#ifdef FLAT
const int kCorners = 4;
const vec3 kTip[4] = vec3[4](vec3(1, 0, 0), vec3(0, 1, 0), vec3(-1, 0, 0), vec3(0, -1, 0));
vec3 turned(vec3 tip) { return tip; }
#else
const int kCorners = 6;
const vec3 kTip[6] = vec3[6](vec3(1, 0, 0), vec3(0, 1, 0), vec3(-1, 0, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1));
vec3 turned(vec3 tip) { return screen_from_normal * tip; }
#endif
void main() {
  uint node = texelFetch(selection, texel(uint(first + gl_VertexID / kCorners)), 0).x;
  place = kTip[gl_VertexID % kCorners];
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  vec4 at = texelFetch(positions, texel(node), 0);
  if (at.w == 0.0) return;
  vec3 mm = (screen_from_model * vec4(at.xyz, 1.0)).xyz;
  float radius_mm = radius_pixels * mm_per_pixel * max(viewer_mm - mm.z, 1.0) / viewer_mm;
  vec4 clip = clip_from_screen * vec4(mm + turned(place) * radius_mm * grow, 1.0);
  if (clip.w <= 0.0) return;
  gl_Position = nearer(clip, radius_mm);  // a sheet doesn't swallow the half that is behind it
}
)";

const char* const kNodeFragment = R"(
in vec3 place;
uniform mat3 screen_from_normal;
uniform vec4 ink;
out vec4 colour;
void main() {
#ifdef FLAT
  const float light = 0.93;
#else
  vec3 normal = screen_from_normal * (sign(place) * 0.57735);  // a face has one sign along each axis
  float light = 0.82 + 0.18 * clamp(dot(normal, vec3(-0.4369, 0.5825, 0.6854)), 0.0, 1.0);
#endif
  colour = vec4(ink.rgb * light, ink.a);
}
)";

// A glyph stands on its shell: the corners come to the picture, in pixels, and what lies between them is drawn there by the fragments. A
// shell that is too small to see is drawn larger about its middle. Depth is that of the corner nearest to the eye.
const char* const kGlyphVertex = R"(
layout(location = 0) in uvec2 glyph;
uniform usampler2D connectivity;
uniform mat2 clip_from_pixels, pixels_from_clip;
uniform float least_pixels;
uniform float mm_per_pixel;
out vec2 at;
flat out vec4 ab, cd, mark;
flat out vec2 before, middle;
flat out float reach;
flat out uint sign_kind;
const float kRim = 9.0;
void main() {
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  at = before = middle = vec2(0.0);
  ab = cd = mark = vec4(0.0);
  reach = 1.0;
  sign_kind = glyph.y;
  uvec4 nodes = texelFetch(connectivity, texel(glyph.x), 0);
  int count = nodes.z == nodes.w ? 3 : 4, k = int(glyph.y >> 5) & 3;
  vec4 place[4] = vec4[4](texelFetch(positions, texel(nodes.x), 0), texelFetch(positions, texel(nodes.y), 0),
                          texelFetch(positions, texel(nodes.z), 0), texelFetch(positions, texel(nodes.w), 0));
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
  if (kind == 1u && count == 3) {  // a triangle's height: from the corner to the foot on the side across
    vec3 side = place[last].xyz - place[next].xyz;
    float share = clamp(dot(place[k].xyz - place[next].xyz, side) / max(dot(side, side), 1e-30), 0.0, 1.0);
    vec4 clip = clip_from_model * vec4(place[next].xyz + share * side, 1.0);
    other = pixels_from_clip * (clip.xy / clip.w);
  }
  middle = count == 3 ? (seen[0] + seen[1] + seen[2]) / 3.0 : 0.25 * (seen[0] + seen[1] + seen[2] + seen[3]);
  if (kind == 6u) middle = seen[k];
  for (int i = 0; i < 4; ++i) reach = max(reach, distance(seen[i], middle));
  float grow = max(1.0, least_pixels / reach);
  reach = kind == 6u ? least_pixels : reach * grow;
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
  float w = max(nearest - (grow > 1.0 ? least_pixels : 1.5) * mm_per_pixel, 0.001);
  gl_Position = vec4(clip_from_pixels * at, depth_terms.x - depth_terms.y / w, 1.0);
}
)";

// Signs by signed distance in pixels (negative inside); their kinds are GlyphShape's.
const char* const kGlyphFragment = R"(
in vec2 at;
flat in vec4 ab, cd, mark;
flat in vec2 before, middle;
flat in float reach;
flat in uint sign_kind;
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
/// 1 inside the corner's angle, as a cosine test about the middle of it.
float corner_sign(vec2 p, uint kind, float w) {
  vec2 c = mark.xy, to_next = unit(mark.zw - c), to_last = unit(before - c);
  float legs = min(length(mark.zw - c), length(before - c));
  float r = clamp(0.42 * legs, 5.5, 22.0);
  vec2 half_way = unit(to_next + to_last + 1e-4 * unit(middle - c));
  float half_cosine = dot(half_way, to_next);
  if (dot(half_way, middle - c) < 0.0) {  // the corner is turned in: the angle is the other one
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
  if (kind == 3u || kind == 4u) return corner_sign(p, kind, w);
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
  uint kind = sign_kind & 15u;
  bool failing = (sign_kind & 16u) != 0u;
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

// The handle, in screen millimetres.
const char* const kHandleVertex = R"(
layout(location = 0) in vec3 at_mm;
layout(location = 1) in vec3 outward;
uniform mat4 clip_from_screen;
out vec3 normal;
void main() {
  normal = outward;
  gl_Position = clip_from_screen * vec4(at_mm, 1.0);
}
)";

const char* const kHandleFragment = R"(
in vec3 normal;
uniform vec4 ink;
out vec4 colour;
void main() {
  vec3 n = normalize(normal);
  float light = 0.58 + 0.42 * max(dot(n, vec3(-0.4369, 0.5825, 0.6854)), 0.0);
  colour = vec4(ink.rgb * light, ink.a);
}
)";

// A rectangle in display pixels, edge and all, over the whole image: what is outside is thrown away.
const char* const kRectangleFragment = R"(
uniform vec4 rectangle;
uniform mat3 picture_from_image;
uniform vec2 soft;
out vec4 colour;
void main() {
  vec2 p = (picture_from_image * vec3(gl_FragCoord.xy, 1.0)).xy;
  vec2 centre = 0.5 * (rectangle.xy + rectangle.zw), half_size = 0.5 * abs(rectangle.zw - rectangle.xy);
  vec2 d = abs(p - centre) - half_size;
  float outside = max(d.x, d.y);
  if (outside > 1.5) discard;
  float line = max(1.0 - max(abs(d.x) / soft.x, 0.0), 1.0 - abs(d.y) / soft.y);
  line = outside > 0.0 ? (d.x > 0.0 && d.y > 0.0 ? 0.0 : line) : line;
  colour = vec4(1.0, 1.0, 1.0, max(clamp(line, 0.0, 1.0) * 0.9, outside <= 0.0 ? 0.08 : 0.0));
}
)";

// A line between two places of the picture (pixels): six vertices a segment, as broad as it and its soft edges need.
const char* const kPencilVertex = R"(
layout(location = 0) in vec4 ends;
layout(location = 1) in float dashes;
uniform mat3 image_from_picture;
uniform float reach;
out vec2 at;
flat out vec4 segment;
flat out float dashed;
void main() {
  vec2 corner = square_corner(gl_VertexID);
  bool second = corner.x > 0.0;
  float side = corner.y;
  vec2 along = ends.zw - ends.xy;
  float size = length(along);
  along = size > 1e-4 ? along / size : vec2(1.0, 0.0);
  at = (second ? ends.zw + along * reach : ends.xy - along * reach) + side * reach * vec2(-along.y, along.x);
  segment = ends;
  dashed = dashes;
  gl_Position = vec4((image_from_picture * vec3(at, 1.0)).xy, 0.0, 1.0);
}
)";

// Dashes count from the segment's start.
const char* const kPencilFragment = R"(
in vec2 at;
flat in vec4 segment;
flat in float dashed;
uniform float half_width;
uniform mat2 pixels_from_texels;
uniform vec4 ink;
uniform vec2 dash;
out vec4 colour;
void main() {
  vec2 along = segment.zw - segment.xy;
  float size = max(length(along), 1e-4);
  float t = clamp(dot(at - segment.xy, along) / size, 0.0, size);
  if (dashed > 0.5) {  // the nearest place that is drawn
    float k = mod(t, dash.x + dash.y);
    if (k > dash.x) t = k > dash.x + 0.5 * dash.y && t - k + dash.x + dash.y < size ? t - k + dash.x + dash.y : t - k + dash.x;
  }
  vec2 off = at - segment.xy - along / size * t;
  float distance = length(off);
  float footprint = distance > 1e-4 ? length((off / distance) * pixels_from_texels) : 1.0;
  float width = dashed > 0.5 ? 0.75 * half_width : half_width;
  float cover = min(clamp((width + 0.5 * footprint - distance) / footprint, 0.0, 1.0), 2.0 * width / footprint);
  if (cover <= 0.004) discard;
  colour = vec4(ink.rgb, ink.a * cover);
}
)";

// Shells laid flat on a shadow's plane, seen from straight before it.
const char* const kShadowCasterVertex = R"(
uniform sampler2D positions;
uniform usampler2D connectivity;
uniform vec3 corner, along_u, along_v;
const int kCorner[6] = int[6](1, 2, 0, 2, 3, 0);
ivec2 texel(uint i) { return ivec2(int(i & 4095u), int(i >> 12)); }
void main() {
  vec4 at = texelFetch(positions, texel(texelFetch(connectivity, texel(uint(gl_VertexID / 6)), 0)[kCorner[gl_VertexID % 6]]), 0);
  vec3 from_corner = at.xyz - corner;
  gl_Position = vec4(2.0 * vec2(dot(from_corner, along_u), dot(from_corner, along_v)) - 1.0, 0.0, 1.0);
  if (at.w == 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
)";

const char* const kShadowCasterFragment = R"(
out vec4 colour;
void main() { colour = vec4(1.0); }
)";

const char* const kShadowPlaneVertex = R"(
uniform mat4 clip_from_model;
uniform vec3 corner, side_u, side_v;
out vec2 place;
void main() {
  place = 0.5 + 0.5 * square_corner(gl_VertexID);
  gl_Position = clip_from_model * vec4(corner + place.x * side_u + place.y * side_v, 1.0);
}
)";

const char* const kShadowPlaneFragment = R"(
in vec2 place;
uniform sampler2D shadow;
uniform vec3 shadow_ink, plane_ink;
uniform float step;
out vec4 colour;
void main() {
  float dark = 0.0, sum = 0.0;
  for (int y = -3; y <= 3; ++y)
    for (int x = -3; x <= 3; ++x) {
      float weight = exp(-0.16 * float(x * x + y * y));
      dark += weight * texture(shadow, place + step * 1.3 * vec2(x, y)).x;
      sum += weight;
    }
  dark /= sum;
  // The plane is there where something falls on it, and fades to its edges: a wall would hem the model in.
  vec2 inside = smoothstep(0.0, 0.25, min(place, 1.0 - place));
  colour = vec4(mix(plane_ink, shadow_ink, dark), mix(0.16 * inside.x * inside.y, 0.55, dark));
}
)";

}  // namespace prismesh::kiosk::render::sign_shaders
