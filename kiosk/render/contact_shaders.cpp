#include "kiosk/render/contact_shaders.h"

namespace prismesh::kiosk::render {

// Stripes on shells, fixed in the model's space: both eyes see the same stripes at the same depth as the surface. They run across a
// diagonal of the coordinate plane that a shell faces most, so on no shell are they wider than 1.8 periods.
const char* const kAlertVertex = R"(
uniform mat3 screen_from_normal;
uniform vec3 eye_in_model;
uniform float toward_eye_mm;
out vec3 at;
flat out vec3 across;
flat out float light;
void main() {
  uvec4 nodes = texelFetch(connectivity, texel(uint(gl_VertexID / 6)), 0);
  vec4 a = texelFetch(positions, texel(nodes.x), 0), b = texelFetch(positions, texel(nodes.y), 0);
  vec4 c = texelFetch(positions, texel(nodes.z), 0), d = texelFetch(positions, texel(nodes.w), 0);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  at = vec3(0.0);
  across = vec3(1.0, 0.0, 0.0);
  light = 1.0;
  if (a.w * b.w * c.w * d.w == 0.0) return;
  int corner = kCorner[gl_VertexID % 6];
  at = (corner == 0 ? a : corner == 1 ? b : corner == 2 ? c : d).xyz;
  cut(at);
  gl_Position = nearer(clip_from_model * vec4(at, 1.0), toward_eye_mm);
  vec3 normal = cross(c.xyz - a.xyz, (nodes.z == nodes.w ? a.xyz : d.xyz) - b.xyz);
  float size = length(normal);
  normal = size > 0.0 ? normal / size : vec3(0.0, 0.0, 1.0);
  if (dot(normal, eye_in_model - at) < 0.0) normal = -normal;
  vec3 most = abs(normal);
  across = most.z >= most.x && most.z >= most.y ? vec3(1.0, 1.0, 0.0) : most.x >= most.y ? vec3(0.0, 1.0, 1.0) : vec3(1.0, 0.0, 1.0);
  across *= 0.70711;
  normal = screen_from_normal * normal;
  light = 0.62 + 0.38 * max(dot(normal, vec3(-0.4369, 0.5825, 0.6854)), 0.0);
}
)";

const char* const kAlertFragment = R"(
in vec3 at;
flat in vec3 across;
flat in float light;
uniform float period;
uniform vec3 bright, dark;
uniform float alpha;
out vec4 colour;
void main() {
  float along = dot(at, across) / period;
  float footprint = max(fwidth(along), 1e-6);
  // A stripe narrower than a texel becomes the mean of both colours.
  float share = clamp((abs(fract(along) - 0.5) - 0.25) / footprint + 0.5, 0.0, 1.0);
  share = mix(share, 0.5, smoothstep(0.5, 1.0, footprint));
  colour = vec4(mix(dark, bright, share) * light, alpha);
}
)";

}  // namespace prismesh::kiosk::render
