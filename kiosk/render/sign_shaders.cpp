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

const char* const kGlyphVertex = R"(
layout(location = 0) in vec3 centre;
layout(location = 1) in uint kind;
uniform mat2 clip_from_pixels;
uniform float radius_pixels;
uniform float mm_per_pixel;
out vec2 place;
flat out uint sign_kind;
void main() {
  place = square_corner(gl_VertexID);
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
