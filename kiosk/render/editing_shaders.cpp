#include "kiosk/render/editing_shaders.h"

namespace prismesh::kiosk::render {

// Selected nodes as octahedra, or as squares standing on a corner where an octahedron would be a few pixels large (FLAT). The texture
// `selection` holds node indices, one row for each chunk; `first` is the index of the row's first texel. Offsets are in screen space, so
// each eye sees the same solid from its own position.
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
  cut(at.xyz);
  if (at.w == 0.0) return;
  vec3 mm = (screen_from_model * vec4(at.xyz, 1.0)).xyz;
  float radius_mm = radius_pixels * mm_per_pixel * max(viewer_mm - mm.z, 1.0) / viewer_mm;
  vec4 clip = clip_from_screen * vec4(mm + turned(place) * radius_mm * grow, 1.0);
  if (clip.w <= 0.0) return;
  gl_Position = nearer(clip, radius_mm);  // keeps the half behind its own surface visible
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

// Shades the handle; its vertices are in screen millimetres.
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

// Draws a rectangle in display pixels with its edge, over the whole image; discards the fragments outside.
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

// Covers a line between two points of the picture (pixels) with six vertices a segment, wide enough for its antialiased edges.
const char* const kScreenLineVertex = R"(
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

// Draws the line. Dashes start at the segment's start.
const char* const kScreenLineFragment = R"(
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
  if (dashed > 0.5) {  // moves t to the nearest point on a dash
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

// Projects shells orthogonally onto the shadow's plane.
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
  // Outside the shadow the plane is faint and fades out towards its edges, so that it doesn't enclose the model.
  vec2 inside = smoothstep(0.0, 0.25, min(place, 1.0 - place));
  colour = vec4(mix(plane_ink, shadow_ink, dark), mix(0.16 * inside.x * inside.y, 0.55, dark));
}
)";

}  // namespace prismesh::kiosk::render
