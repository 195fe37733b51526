#include "kiosk/render/shaders.h"

#include <string>

#include "kiosk/render/contact_shaders.h"
#include "kiosk/render/editing_shaders.h"
#include "kiosk/render/glyph_shaders.h"

namespace prismesh::kiosk::render {

const std::string& shader_head() {
  static const std::string kHead = R"(#version 310 es
#extension GL_EXT_clip_cull_distance : enable
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

// texel() gives the place of entry i in the model's textures. cut() keeps a vertex's distance from the plane above which the model is cut
// away. nearer() moves a vertex toward the eye by `mm` in depth only; its place in
// the picture stays. `over_plates_mm`: by so much more, from a shell's mid-surface to before its outer face.
const char* const kPull = R"(
uniform sampler2D positions;
uniform mat4 clip_from_model;
uniform vec2 depth_terms;
uniform float over_plates_mm;
uniform vec4 cut_plane;
#ifdef GL_EXT_clip_cull_distance
void cut(vec3 at) { gl_ClipDistance[0] = dot(cut_plane, vec4(at, 1.0)); }
#else
void cut(vec3 at) {}
#endif
ivec2 texel(uint i) { return ivec2(int(i & 4095u), int(i >> 12)); }
vec4 nearer(vec4 clip, float mm) {
  float w = max(clip.w - mm - over_plates_mm, 0.001);
  return vec4(clip.xy, (depth_terms.x - depth_terms.y / w) * clip.w, clip.w);
}
)";

// The corner (-1 or 1 on each axis) of a square's two triangles for each of six vertices.
const char* const kSquareCorner = R"(
vec2 square_corner(int vertex) {
  int k = vertex % 6;
  return vec2(k == 1 || k == 2 || k == 4 ? 1.0 : -1.0, k == 2 || k == 4 || k == 5 ? 1.0 : -1.0);
}
)";

const char* const kShellPull = R"(
uniform usampler2D connectivity, surface;
const int kCorner[6] = int[6](1, 2, 0, 2, 3, 0);
uint node_of(uvec4 nodes, int corner) { return corner == 0 ? nodes.x : corner == 1 ? nodes.y : corner == 2 ? nodes.z : nodes.w; }
)";

// What was chosen for a part: a colour (bit 24 says so) and whether it is transparent (bit 25). `see_through`: transparent parts are drawn,
// else the others.
const char* const kPaint = R"(
uniform usampler2D part_paint;
uniform int painted_parts, see_through;
uint paint_of(uint part) { return part < uint(painted_parts) ? texelFetch(part_paint, texel(part), 0).x : 0u; }
bool is_drawn(uint paint) { return int((paint >> 25) & 1u) == see_through; }
)";

// Flat outputs take the value of a triangle's last vertex, which is corner 0 for both halves of a quad.
const char* const kShellVertex = R"(
uniform vec3 palette[22];
uniform vec3 grades[3];
uniform int by_grade;
uniform sampler2D field;
uniform int field_kind;
uniform usampler2D part_looks;
uniform int part_count;
uniform mat3 screen_from_normal;
uniform vec3 eye_in_model;
out vec2 place;
out vec2 value;
flat out float shade;
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
#ifdef COARSE
uniform usampler2D coarse;
#endif
#ifdef PLATES
// Instances are the upper face, the lower one and four sides, each seen from outside. Corner 0 of a face is corner 0 of the shell, or of its
// side, on the upper face.
uniform usampler2D plates, thicknesses;
uniform int thick_parts, show_inside;
flat out float is_thick;
vec3 way_of(uint word) { return vec3(ivec3(int(word << 22), int(word << 12), int(word << 2)) >> 22) / 256.0; }
#endif
void main() {
#ifdef PLATES
  is_thick = 0.0;
#endif
#ifdef COARSE
  uvec4 row = texelFetch(coarse, texel(uint(gl_VertexID / 3)), 0);
  uint shell = row.w;
  int corner = gl_VertexID % 3;
#else
  uint shell = uint(gl_VertexID >> 2);
  int corner = gl_VertexID & 3;
#endif
  uvec2 word = texelFetch(surface, texel(shell), 0).xy;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  place = vec2(0.0);
  value = vec2(0.0);
  shade = 1.0;
  look = vec3(0.0);
  triangle = 0.0;
  uint part = word.x >> 9;
  uint paint = paint_of(part);
  if ((word.x & 256u) != 0u || !is_drawn(paint)) return;
#ifdef COARSE
  uvec4 nodes = row.xyzz;
#else
  uvec4 nodes = texelFetch(connectivity, texel(shell), 0);
#endif
#ifdef PLATES
  float half_thick = part < uint(thick_parts) ? 0.5 * uintBitsToFloat(texelFetch(thicknesses, texel(part), 0).x) : 0.0;
  uvec4 plate = half_thick > 0.0 ? texelFetch(plates, texel(shell), 0) : uvec4(0u);
  int face = gl_InstanceID, side = face - 2;
  if (face >= 2 && (node_of(plate, side) & 0x40000000u) == 0u) return;
  if (face == 1 && half_thick == 0.0 && show_inside == 1) return;
  is_thick = half_thick > 0.0 ? 1.0 : 0.0;
  place = vec2(corner >= 2 ? 1.0 : 0.0, corner == 1 || corner == 2 ? 1.0 : 0.0);  // of a side
  float up = face == 1 || (face >= 2 && place.y > 0.0) ? -half_thick : half_thick;
  if (face == 1) corner = (4 - corner) & 3;
  if (face >= 2) corner = corner < 2 ? side : (side + 1) & 3;
  vec3 at = texelFetch(positions, texel(node_of(nodes, corner)), 0).xyz + up * way_of(node_of(plate, corner));
#else
  vec3 at = texelFetch(positions, texel(node_of(nodes, corner)), 0).xyz;
#endif
  cut(at);
  gl_Position = clip_from_model * vec4(at, 1.0);
  triangle = nodes.z == nodes.w ? 1.0 : 0.0;
#ifdef PLATES
  if (face >= 2) triangle = 0.0;
  if (face < 2)
#endif
#ifdef COARSE
  place = vec2(0.5);  // no element edges
  triangle = 0.0;
#else
  place = vec2(corner == 1 || (corner == 2 && triangle == 0.0) ? 1.0 : 0.0, corner >= 2 ? 1.0 : 0.0);
#endif

  vec3 normal = unpack_normal(word.y);
#ifdef PLATES
  if (face >= 2) {
    vec3 along = texelFetch(positions, texel(node_of(nodes, (side + 1) & 3)), 0).xyz - texelFetch(positions, texel(node_of(nodes, side)), 0).xyz;
    vec3 across = cross(along, normal);
    normal = across / max(length(across), 1e-30);
  }
#endif
  if (dot(normal, eye_in_model - at) < 0.0) normal = -normal;
  normal = screen_from_normal * normal;
  const vec3 kKey = vec3(-0.4369, 0.5825, 0.6854);
  const vec3 kFill = vec3(0.2747, -0.7325, 0.6229);
  float key = max(dot(normal, kKey), 0.0), fill = max(dot(normal, kFill), 0.0);
  float light = 0.48 + 0.40 * key + 0.12 * fill + 0.14 * max(normal.z, 0.0);
  vec3 base = by_grade == 1 ? grades[min((word.x >> 5) & 3u, 2u)] : palette[min(word.x & 31u, 21u)];
  if (by_grade == 0 && (paint & 0x1000000u) != 0u) base = unpackUnorm4x8(paint).rgb;
  if (by_grade == 2) base = part < uint(part_count) ? unpackUnorm4x8(texelFetch(part_looks, texel(part), 0).x).rgb : grades[0];
  if ((word.x & 128u) != 0u) base = mix(base, vec3(1.0), 0.55);
  look = base * light;
  shade = mix(light, 1.0, 0.3);  // shade field colours less, so that values stay readable
  if (field_kind == 1) value = texelFetch(field, texel(node_of(nodes, corner)), 0).xy;
  if (field_kind == 2) value = texelFetch(field, texel(shell), 0).xy;
}
)";

// Draws element edges from the distance to the nearest side in the shell's own unit square or triangle, divided by its gradient. A quad's
// diagonal can't appear. An eye's image may be narrower than the picture, or sheared: `texels_from_pixels` maps steps on the display to
// steps in the image, and widths are measured on the display. A gradient times this matrix (as a row vector) is a gradient on the display.
const char* const kShellFragment = R"(
in vec2 place;
in vec2 value;
flat in float shade;
flat in vec3 look;
flat in float triangle;
uniform mat2 texels_from_pixels, pixels_from_texels;
uniform float edge_strength;
uniform float opacity;
uniform sampler2D colour_map;
uniform vec3 limits;  // start of the value range, 1 / its length, number of bands
#ifdef PLATES
flat in float is_thick;
uniform int show_inside;
#endif
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
  // Edges fade out where elements are a few pixels large, so that they don't cover the part's colour.
  float edge_share = smoothstep(3.0, 14.0, min(extent(s), extent(t)));
  vec3 painted = look;
  float share = (value.x - limits.x) * limits.y;
  if (value.y > 0.999 && share > 0.0) {
    share = min(share, 1.0);
    if (limits.z > 0.0) share = (floor(min(share, 0.9999) * limits.z) + 0.5) / limits.z;
    painted = texture(colour_map, vec2((share * 255.0 + 0.5) / 256.0, 0.5)).rgb * shade;
  }
#ifdef PLATES
  if (show_inside == 1 && is_thick > 0.5 && !gl_FrontFacing) {  // a cut opens the plate: its inside is one darker tone
    colour = vec4(0.55 * painted, opacity);
    return;
  }
#endif
  colour = vec4(painted * (1.0 - edge_strength * edge * edge_share), opacity);
}
)";

const char* const kPaneVertex = R"(
uniform vec2 corner_a, corner_b, corner_c, corner_d;
const int kOf[6] = int[6](0, 1, 2, 0, 2, 3);
void main() {
  int i = kOf[gl_VertexID];
  gl_Position = vec4(i == 0 ? corner_a : i == 1 ? corner_b : i == 2 ? corner_c : corner_d, 0.0, 1.0);
}
)";

const char* const kPaneFragment = R"(
out vec4 colour;
void main() { colour = vec4(0.0); }
)";

const char* const kItemVertex = R"(
flat out uint item;
void main() {
  uint shell = uint(gl_VertexID >> 2);
  item = shell + 1u;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  uint word = texelFetch(surface, texel(shell), 0).x;
  if ((word & 256u) != 0u || !is_drawn(paint_of(word >> 9))) return;
  uvec4 nodes = texelFetch(connectivity, texel(shell), 0);
  vec3 at = texelFetch(positions, texel(node_of(nodes, gl_VertexID & 3)), 0).xyz;
  cut(at);
  gl_Position = clip_from_model * vec4(at, 1.0);
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
uniform float min_alpha;
out float across_pixels;
flat out float presence;
flat out float footprint;
void main() {
  uvec2 ends = texelFetch(lines, texel(uint(gl_VertexID / 6)), 0).xy;
  vec2 corner = square_corner(gl_VertexID);
  bool second = corner.x > 0.0;
  float side = corner.y;
  vec4 pa = texelFetch(positions, texel(ends.x), 0), pb = texelFetch(positions, texel(ends.y), 0);
  vec4 a = clip_from_model * vec4(pa.xyz, 1.0), b = clip_from_model * vec4(pb.xyz, 1.0);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  across_pixels = 0.0;
  footprint = 1.0;
  presence = 0.0;
  cut((second ? pb : pa).xyz);
  if (pa.w == 0.0 || pb.w == 0.0 || a.w <= 0.0 || b.w <= 0.0) return;
  vec2 along = 2.0 * (pixels_from_clip * (b.xy / b.w - a.xy / a.w));
  float length_pixels = length(along);
  along = length_pixels > 1e-4 ? along / length_pixels : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  footprint = length(across * pixels_from_texels);
  presence = mix(min_alpha, 1.0, smoothstep(3.0, 16.0, length_pixels));  // short lines are crowded: they fade
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

}  // namespace

Result<Shaders> Shaders::link() {
  Shaders shaders;
  struct Entry {
    gl::Program Shaders::*program;
    const char* name;
    std::string vertex;
    std::string fragment;
  };
  const std::string& head = shader_head();
  const std::string pull = head + kPull, shell = pull + kShellPull, flat = "#define FLAT\n", plates = "#define PLATES\n";
  const Entry entries[] = {
      {&Shaders::ground, "ground", cover_vertex_shader(), head + kGroundFragment},
      {&Shaders::shells, "shells", shell + kPaint + kShellVertex, head + kShellFragment},
      {&Shaders::plates, "plates", shell + plates + kPaint + kShellVertex, head + plates + kShellFragment},
      {&Shaders::coarse, "coarse triangles", shell + "#define COARSE\n" + kPaint + kShellVertex, head + kShellFragment},
      {&Shaders::items, "items", shell + kPaint + kItemVertex, head + kItemFragment},
      {&Shaders::lines, "lines", pull + kSquareCorner + kLineVertex, head + kLineFragment},
      {&Shaders::nodes, "nodes", pull + kNodeVertex, head + kNodeFragment},
      {&Shaders::flat_nodes, "flat nodes", pull + flat + kNodeVertex, head + flat + kNodeFragment},
      {&Shaders::glyphs, "glyphs", pull + kSquareCorner + kGlyphVertex, head + kGlyphFragment},
      {&Shaders::alert, "alert", shell + kAlertVertex, head + kAlertFragment},
      {&Shaders::handle, "handle", head + kHandleVertex, head + kHandleFragment},
      {&Shaders::pane, "pane", head + kPaneVertex, head + kPaneFragment},
      {&Shaders::rectangle, "rectangle", cover_vertex_shader(), head + kRectangleFragment},
      {&Shaders::screen_lines, "screen lines", head + kSquareCorner + kScreenLineVertex, head + kScreenLineFragment},
      {&Shaders::shadow_caster, "shadow caster", head + kShadowCasterVertex, head + kShadowCasterFragment},
      {&Shaders::shadow_plane, "shadow plane", head + kSquareCorner + kShadowPlaneVertex, head + kShadowPlaneFragment}};
  for (const Entry& entry : entries) {
    Result<gl::Program> program = gl::Program::link(entry.name, entry.vertex, entry.fragment);
    if (!program) return fail(program.error());
    shaders.*entry.program = std::move(*program);
  }
  return shaders;
}

}  // namespace prismesh::kiosk::render
