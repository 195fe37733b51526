#include "kiosk/render/shaders.h"

#include <string>

namespace prismesh::kiosk::render {

const std::string& shader_head() {
  static const std::string kHead = R"(#version 310 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
)";
  return kHead;
}

const std::string& cover_vertex_shader() {
  static const std::string kShader = shader_head() + R"(
void main() { gl_Position = vec4(float(gl_VertexID & 1) * 4.0 - 1.0, float(gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0); }
)";
  return kShader;
}

namespace {

const char* const kGroundFragment = R"(
uniform vec3 top, bottom;
uniform float height;
out vec4 colour;
void main() {
  float t = smoothstep(0.0, 1.0, gl_FragCoord.y / height);
  colour = vec4(mix(bottom, top, t), 1.0);
}
)";

// What pulls the model out of its textures, and moves things toward the eye by so many mm without moving them in the picture.
const char* const kPull = R"(
uniform sampler2D positions;
uniform mat4 clip_from_model;
uniform vec2 depth_terms;
ivec2 texel(uint i) { return ivec2(int(i & 4095u), int(i >> 12)); }
vec4 nearer(vec4 clip, float mm) {
  float w = max(clip.w - mm, 0.001);
  return vec4(clip.xy, (depth_terms.x - depth_terms.y / w) * clip.w, clip.w);
}
)";

const char* const kShellPull = R"(
uniform usampler2D connectivity, surface;
const int kCorner[6] = int[6](1, 2, 0, 2, 3, 0);
uint node_of(uvec4 nodes, int corner) { return corner == 0 ? nodes.x : corner == 1 ? nodes.y : corner == 2 ? nodes.z : nodes.w; }
)";

// Flat values come from the last vertex of a triangle: corner 0 for both halves of a quad.
const char* const kShellVertex = R"(
uniform vec3 palette[22];
uniform vec3 grades[3];
uniform int by_grade;
uniform mat3 screen_from_normal;
uniform vec3 eye_in_model;
out vec2 place;
flat out vec3 look;
flat out float triangle;
vec3 unpack_normal(uint halves) {
  vec2 f = unpackSnorm2x16(halves);
  vec3 n = vec3(f, 1.0 - abs(f.x) - abs(f.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  return normalize(n);
}
void main() {
  uint shell = uint(gl_VertexID / 6);
  int corner = kCorner[gl_VertexID % 6];
  uvec2 word = texelFetch(surface, texel(shell), 0).xy;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  place = vec2(0.0);
  look = vec3(0.0);
  triangle = 0.0;
  if ((word.x & 256u) != 0u) return;
  uvec4 nodes = texelFetch(connectivity, texel(shell), 0);
  vec3 at = texelFetch(positions, texel(node_of(nodes, corner)), 0).xyz;
  gl_Position = clip_from_model * vec4(at, 1.0);
  triangle = nodes.z == nodes.w ? 1.0 : 0.0;
  place = vec2(corner == 1 || (corner == 2 && triangle == 0.0) ? 1.0 : 0.0, corner >= 2 ? 1.0 : 0.0);

  vec3 normal = unpack_normal(word.y);
  if (dot(normal, eye_in_model - at) < 0.0) normal = -normal;
  normal = screen_from_normal * normal;
  const vec3 kKey = vec3(-0.4369, 0.5825, 0.6854);
  const vec3 kFill = vec3(0.2747, -0.7325, 0.6229);
  float key = max(dot(normal, kKey), 0.0), fill = max(dot(normal, kFill), 0.0);
  float light = 0.48 + 0.40 * key + 0.12 * fill + 0.14 * max(normal.z, 0.0);
  vec3 base = by_grade != 0 ? grades[min((word.x >> 5) & 3u, 2u)] : palette[min(word.x & 31u, 21u)];
  if ((word.x & 128u) != 0u) base = mix(base, vec3(1.0), 0.55);
  look = base * light;
}
)";

// Images may be narrower than the picture, or sheared: `texels_from_pixels` takes steps on the display to steps in the image, and
// widths are those on the display. Row vectors times it: gradients the other way.

// Distance to the nearest side, in the shell's own square or triangle, over how fast that changes: no diagonal can appear.
const char* const kShellFragment = R"(
in vec2 place;
flat in vec3 look;
flat in float triangle;
uniform mat2 texels_from_pixels, pixels_from_texels;
uniform float edge_strength;
out vec4 colour;
float cover(float distance, vec2 gradient) {
  gradient = gradient * texels_from_pixels;
  float slope = max(length(gradient), 1e-9);
  vec2 across = gradient / slope;
  float footprint = length(across * pixels_from_texels);
  const float kHalf = 0.55;
  return min(clamp((kHalf + 0.5 * footprint - distance / slope) / footprint, 0.0, 1.0), 2.0 * kHalf / footprint);
}
float extent(vec2 gradient) { return 1.0 / max(length(gradient * texels_from_pixels), 1e-9); }
void main() {
  vec2 s = vec2(dFdx(place.x), dFdy(place.x)), t = vec2(dFdx(place.y), dFdy(place.y));
  float edge = max(cover(place.x, s), cover(place.y, t));
  if (triangle > 0.5)
    edge = max(edge, cover(1.0 - place.x - place.y, s + t));
  else
    edge = max(edge, max(cover(1.0 - place.x, s), cover(1.0 - place.y, t)));
  // Where elements are a few pixels small their edges would turn the part into mud.
  float room = smoothstep(3.0, 14.0, min(extent(s), extent(t)));
  colour = vec4(look * (1.0 - edge_strength * edge * room), 1.0);
}
)";

const char* const kItemVertex = R"(
flat out uint item;
void main() {
  uint shell = uint(gl_VertexID / 6);
  item = shell + 1u;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if ((texelFetch(surface, texel(shell), 0).x & 256u) != 0u) return;
  uvec4 nodes = texelFetch(connectivity, texel(shell), 0);
  gl_Position = clip_from_model * vec4(texelFetch(positions, texel(node_of(nodes, kCorner[gl_VertexID % 6])), 0).xyz, 1.0);
}
)";

const char* const kItemFragment = R"(
flat in uint item;
layout(location = 0) out uint number;
void main() { number = item; }
)";

const char* const kLineVertex = R"(
uniform usampler2D lines;
uniform mat2 clip_from_pixels, pixels_from_clip, pixels_from_texels;
uniform float half_width;
uniform float toward_eye_mm;
uniform float least_alpha;
out float across_pixels;
flat out float presence;
flat out float footprint;
void main() {
  uvec2 ends = texelFetch(lines, texel(uint(gl_VertexID / 6)), 0).xy;
  int k = gl_VertexID % 6;
  bool second = k == 1 || k == 2 || k == 4;
  float side = k == 2 || k == 4 || k == 5 ? 1.0 : -1.0;
  vec4 pa = texelFetch(positions, texel(ends.x), 0), pb = texelFetch(positions, texel(ends.y), 0);
  vec4 a = clip_from_model * vec4(pa.xyz, 1.0), b = clip_from_model * vec4(pb.xyz, 1.0);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  across_pixels = 0.0;
  footprint = 1.0;
  presence = 0.0;
  if (pa.w == 0.0 || pb.w == 0.0 || a.w <= 0.0 || b.w <= 0.0) return;
  vec2 along = 2.0 * (pixels_from_clip * (b.xy / b.w - a.xy / a.w));
  float length_pixels = length(along);
  along = length_pixels > 1e-4 ? along / length_pixels : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  footprint = length(across * pixels_from_texels);
  presence = mix(least_alpha, 1.0, smoothstep(3.0, 16.0, length_pixels));  // short lines stand close: they step back
  float reach = half_width + 0.5 * footprint + 0.5;
  across_pixels = side * reach;
  vec4 clip = nearer(second ? b : a, toward_eye_mm);
  vec2 offset = across * across_pixels + along * (second ? 0.5 : -0.5) * half_width;
  gl_Position = clip + vec4(clip_from_pixels * offset * clip.w, 0.0, 0.0);
}
)";

const char* const kLineFragment = R"(
in float across_pixels;
flat in float footprint;
flat in float presence;
uniform float half_width;
uniform vec4 ink;
out vec4 colour;
void main() {
  float cover = min(clamp((half_width + 0.5 * footprint - abs(across_pixels)) / footprint, 0.0, 1.0), 2.0 * half_width / footprint);
  if (cover <= 0.004) discard;
  colour = vec4(ink.rgb, ink.a * presence * cover);
}
)";

const char* const kNodeVertex = R"(
layout(location = 0) in uint node;
uniform mat2 clip_from_pixels;
uniform float radius_pixels;
uniform float mm_per_pixel;
uniform mat3 screen_from_normal;
uniform float grow;
flat out float light;
const vec3 kTip[6] = vec3[6](vec3(1, 0, 0), vec3(0, 1, 0), vec3(-1, 0, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1));
void main() {
  int face = gl_VertexID / 3, k = gl_VertexID % 3;
  int quarter = face & 3;
  bool upper = face < 4;
  int tip = k == 2 ? (upper ? 4 : 5) : ((k == 0) == upper ? quarter : (quarter + 1) & 3);
  vec3 normal = screen_from_normal * normalize(kTip[quarter] + kTip[(quarter + 1) & 3] + kTip[upper ? 4 : 5]);
  light = 0.82 + 0.18 * clamp(dot(normal, vec3(-0.4369, 0.5825, 0.6854)), 0.0, 1.0);
  vec3 offset = screen_from_normal * kTip[tip] * radius_pixels * grow;
  vec4 at = texelFetch(positions, texel(node), 0);
  vec4 clip = clip_from_model * vec4(at.xyz, 1.0);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (at.w == 0.0 || clip.w <= 0.0) return;
  clip = nearer(clip, (offset.z + radius_pixels) * mm_per_pixel);
  gl_Position = clip + vec4(clip_from_pixels * offset.xy * clip.w, 0.0, 0.0);
}
)";

const char* const kNodeFragment = R"(
flat in float light;
uniform vec4 ink;
out vec4 colour;
void main() { colour = vec4(ink.rgb * light, ink.a); }
)";

const char* const kGlyphVertex = R"(
layout(location = 0) in vec3 centre;
layout(location = 1) in uint kind;
uniform mat2 clip_from_pixels;
uniform float radius_pixels;
uniform float mm_per_pixel;
out vec2 place;
flat out uint sign_kind;
void main() {
  int k = gl_VertexID;
  place = vec2(k == 1 || k == 2 || k == 4 ? 1.0 : -1.0, k == 2 || k == 4 || k == 5 ? 1.0 : -1.0);
  sign_kind = kind;
  vec4 clip = clip_from_model * vec4(centre, 1.0);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (clip.w <= 0.0) return;
  clip = nearer(clip, radius_pixels * mm_per_pixel);
  gl_Position = clip + vec4(clip_from_pixels * place * radius_pixels * clip.w, 0.0, 0.0);
}
)";

// Signs by signed distance (negative inside). 0 warped quad: a bow tie with its bent diagonal; 1 length: a short bar between stops;
// 2 angle: an open wedge; 3 aspect: a slender box; 4 other: a disc.
const char* const kGlyphFragment = R"(
in vec2 place;
flat in uint sign_kind;
uniform vec3 warn_ink, fail_ink;
out vec4 colour;
float box(vec2 p, vec2 half_size) {
  vec2 d = abs(p) - half_size;
  return length(max(d, 0.0)) + min(max(d.x, d.y), 0.0);
}
float segment(vec2 p, vec2 a, vec2 b) {
  vec2 along = b - a;
  return length(p - a - along * clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0));
}
float shape(vec2 p, uint kind) {
  if (kind == 0u) {
    vec2 q = abs(p);
    float wings = max(max(q.x - 0.66, (q.y - q.x) * 0.7071), -1.0);
    return min(wings, segment(p, vec2(-0.62, -0.62), vec2(0.62, 0.62)) - 0.13);
  }
  if (kind == 1u) return min(box(p, vec2(0.5, 0.14)), box(vec2(abs(p.x) - 0.5, p.y), vec2(0.14, 0.55)));
  if (kind == 2u)
    return min(segment(p, vec2(-0.55, -0.42), vec2(0.62, -0.42)), segment(p, vec2(-0.55, -0.42), vec2(0.36, 0.55))) - 0.16;
  if (kind == 3u) return box(p, vec2(0.72, 0.26));
  return length(p) - 0.48;
}
void main() {
  uint kind = sign_kind & 7u;
  bool failing = (sign_kind & 8u) != 0u;
  float distance = shape(place, kind);
  float soft = max(fwidth(place.x), fwidth(place.y)) * 0.5;
  float body = 1.0 - smoothstep(-soft, soft, distance);
  float rim = 1.0 - smoothstep(-soft, soft, distance - 0.17);
  if (rim < 0.02) discard;
  vec3 ink = failing ? fail_ink : warn_ink;
  vec3 outline = failing ? vec3(0.25, 0.02, 0.02) : vec3(0.20, 0.16, 0.02);
  colour = vec4(mix(outline, ink, body), rim);
}
)";

const char* const kHandleVertex = R"(
layout(location = 0) in vec2 circle;
layout(location = 1) in vec2 stem;
layout(location = 2) in vec2 slant;
uniform mat4 clip_from_screen;
uniform vec3 foot, axis, side_a, side_b;
out vec3 normal;
void main() {
  vec3 out_of_axis = circle.x * side_a + circle.y * side_b;
  normal = normalize(normalize(out_of_axis + axis * 1e-6) * slant.x + normalize(axis) * slant.y);
  gl_Position = clip_from_screen * vec4(foot + axis * stem.x + out_of_axis * stem.y, 1.0);
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

}  // namespace

Result<Shaders> Shaders::link() {
  Shaders shaders;
  struct Entry {
    gl::Program Shaders::*program;
    const char* name;
    std::string vertex;
    std::string fragment;
  };
  const std::string pull = shader_head() + kPull, shell = pull + kShellPull;
  const Entry entries[] = {{&Shaders::ground, "ground", cover_vertex_shader(), shader_head() + kGroundFragment},
                           {&Shaders::shells, "shells", shell + kShellVertex, shader_head() + kShellFragment},
                           {&Shaders::items, "items", shell + kItemVertex, shader_head() + kItemFragment},
                           {&Shaders::lines, "lines", pull + kLineVertex, shader_head() + kLineFragment},
                           {&Shaders::nodes, "nodes", pull + kNodeVertex, shader_head() + kNodeFragment},
                           {&Shaders::glyphs, "glyphs", pull + kGlyphVertex, shader_head() + kGlyphFragment},
                           {&Shaders::handle, "handle", shader_head() + kHandleVertex, shader_head() + kHandleFragment},
                           {&Shaders::rectangle, "rectangle", cover_vertex_shader(), shader_head() + kRectangleFragment}};
  for (const Entry& entry : entries) {
    Result<gl::Program> program = gl::Program::link(entry.name, entry.vertex, entry.fragment);
    if (!program) return fail(program.error());
    shaders.*entry.program = std::move(*program);
  }
  return shaders;
}

}  // namespace prismesh::kiosk::render
