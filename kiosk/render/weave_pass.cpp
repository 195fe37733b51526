#include "kiosk/render/weave_pass.h"

#include <utility>

#include "kiosk/render/shaders.h"

namespace prismesh::kiosk::render {

namespace {

// Each (sub)pixel of the display is one texel of one eye's image, so all reads are texelFetch. Numbers are those of the phase map
// (drivers/display/phase_map.h).
const char* const kDeclarations = R"(
uniform sampler2D left_eye, right_eye, phases;
uniform bool swapped;
uniform ivec2 picture;
uniform ivec2 image;
uniform float nodes_per_pixel;
uniform float subpixel;
uniform vec2 leak;
uniform float gamma;
out vec4 colour;
vec3 fetch(bool left, ivec2 q) { return left ? texelFetch(left_eye, q, 0).rgb : texelFetch(right_eye, q, 0).rgb; }
)";

// Compensates crosstalk: the colour to show to an eye so that, with the leak of the other eye's light, it sees its own colour. Black is
// raised by the leak, so that the difference is never negative.
const char* const kShown = R"(
#if LEAKING
vec3 without_leak(vec3 own, vec3 other, float into_own, float into_other) {
  vec3 wanted = into_own + (1.0 - into_own) * pow(own, vec3(gamma));
  vec3 wanted_other = into_other + (1.0 - into_other) * pow(other, vec3(gamma));
  return pow(clamp((wanted - into_own * wanted_other) / (1.0 - into_own * into_other), 0.0, 1.0), vec3(1.0 / gamma));
}
vec3 shown(bool left, vec3 own, vec3 other) {
  vec2 into = left ? leak : leak.yx;
  return without_leak(own, other, into.x, into.y);
}
#else
vec3 shown(bool left, vec3 own, vec3 other) { return own; }
#endif
)";

const char* const kNumbers = R"(
// Both eyes' numbers at a pixel's middle, and their change over one pixel to the right.
void read_numbers(ivec2 p, out vec2 numbers, out vec2 slope) {
  vec2 at = (vec2(p) + 0.5) * nodes_per_pixel;
  ivec2 node = ivec2(at);
  vec2 t = at - vec2(node);
  vec2 a = texelFetch(phases, node, 0).xy, b = texelFetch(phases, node + ivec2(1, 0), 0).xy;
  vec2 c = texelFetch(phases, node + ivec2(0, 1), 0).xy, d = texelFetch(phases, node + ivec2(1, 1), 0).xy;
  vec2 across = (b - a) + t.y * ((d - c) - (b - a));
  numbers = a + t.y * (c - a) + t.x * across;
  slope = across * nodes_per_pixel;
}
bool left_shows(vec2 numbers) {
  vec2 off = abs(numbers - floor(numbers + 0.5));
  return off.x <= off.y;
}
)";

const char* const kInterlaced = R"(
ivec2 texel(float number, ivec2 p) {
#if BY_ROWS
  return ivec2(p.x, clamp(int(number), 0, image.y - 1));
#else
  return ivec2(clamp(int(number), 0, image.x - 1), p.y);
#endif
}
vec3 interlaced(vec2 numbers, ivec2 p) {
  bool left = left_shows(numbers);
  float own = left ? numbers.x : numbers.y, other = left ? numbers.y : numbers.x;
  vec3 light = fetch(left, texel(floor(own + 0.5), p));
#if LEAKING
  // The other eye has no texel at this number: interpolate between its two nearest ones.
  float below = floor(other);
  vec3 beside = mix(fetch(!left, texel(below, p)), fetch(!left, texel(below + 1.0, p)), other - below);
  return shown(left, light, beside);
#else
  return light;
#endif
}
vec3 woven(ivec2 p) {
  vec2 numbers, slope;
  read_numbers(p, numbers, slope);
#if SUBPIXELS
  vec2 aside = subpixel * slope;
  return vec3(interlaced(numbers - aside, p).r, interlaced(numbers, p).g, interlaced(numbers + aside, p).b);
#else
  return interlaced(numbers, p);
#endif
}
)";

const char* const kStencil = R"(
vec3 woven(ivec2 p) {
  vec2 numbers, slope;
  read_numbers(p, numbers, slope);
  bool left = left_shows(numbers);
  return shown(left, fetch(left, p), fetch(!left, p));
}
)";

const char* const kAlone = R"(
vec3 woven(ivec2 p) {
  vec3 only = texelFetch(left_eye, p, 0).rgb;
  return shown(true, only, only);
}
)";

const char* const kAnaglyph = R"(
float grey(vec3 c) { return dot(c, vec3(0.299, 0.587, 0.114)); }
vec3 woven(ivec2 p) { return vec3(grey(fetch(!swapped, p)), fetch(swapped, p).gb); }
)";

const char* const kBeside = R"(
vec3 woven(ivec2 p) {
  bool second = p.x >= image.x;
  ivec2 q = ivec2(second ? p.x - image.x : p.x, p.y);
  bool left = second == swapped;
  return shown(left, fetch(left, q), fetch(!left, q));
}
)";

const char* const kStacked = R"(
vec3 woven(ivec2 p) {
  int row = picture.y - 1 - p.y;
  bool second = row >= image.y;
  ivec2 q = ivec2(p.x, image.y - 1 - (second ? row - image.y : row));
  bool left = second == swapped;
  return shown(left, fetch(left, q), fetch(!left, q));
}
)";

const char* const kMain = R"(
void main() { colour = vec4(woven(ivec2(gl_FragCoord.xy)), 1.0); }
)";

}  // namespace

std::string WeavePass::fragment_shader(const Variant& variant) {
  const auto define = [](const char* name, bool value) { return std::string("#define ") + name + (value ? " 1\n" : " 0\n"); };
  std::string shader =
      shader_head() + define("BY_ROWS", variant.by_rows) + define("SUBPIXELS", variant.subpixels) + define("LEAKING", variant.leaking);
  shader += kDeclarations;
  shader += kShown;
  switch (variant.join) {
    case Join::alone: shader += kAlone; break;
    case Join::interlaced: (shader += kNumbers) += kInterlaced; break;
    case Join::stencil: (shader += kNumbers) += kStencil; break;
    case Join::anaglyph: shader += kAnaglyph; break;
    case Join::beside: shader += kBeside; break;
    case Join::stacked: shader += kStacked; break;
  }
  return shader + kMain;
}

Result<const gl::Program*> WeavePass::program_for(const Variant& variant) {
  auto known = programs_.find(variant);
  if (known == programs_.end()) {
    Result<gl::Program> program = gl::Program::link("weave", cover_vertex_shader(), fragment_shader(variant));
    if (!program) return fail(program.error());
    known = programs_.emplace(variant, std::move(*program)).first;
  }
  return &known->second;
}

void WeavePass::upload(const drivers::display::PhaseMap& phases) {
  glActiveTexture(GL_TEXTURE0 + unit::kPhases);
  if (!phases_ || columns_ != phases.columns || rows_ != phases.rows) {
    phases_ = gl::Texture::make();
    glBindTexture(GL_TEXTURE_2D, phases_.get());
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RG32F, phases.columns, phases.rows);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    columns_ = phases.columns;
    rows_ = phases.rows;
  }
  glBindTexture(GL_TEXTURE_2D, phases_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, phases.columns, phases.rows, GL_RG, GL_FLOAT, phases.numbers.data());
}

Result<void> WeavePass::draw(const Composition& composition, const EyeImages& images, unsigned framebuffer, int width, int height) {
  const bool leaking = composition.leak != std::array<double, 2>{0, 0};
  const auto found = program_for({composition.join, composition.by_rows, composition.subpixel != 0, leaking});
  if (!found) return fail(found.error());
  const gl::Program& program = **found;
  if (composition.phases.columns > 0) upload(composition.phases);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  images.bind_texture(0, unit::kLeft);
  images.bind_texture(composition.images.size() > 1 ? 1 : 0, unit::kRight);
  program.use();
  program.set("left_eye", static_cast<int>(unit::kLeft));
  program.set("right_eye", static_cast<int>(unit::kRight));
  program.set("phases", static_cast<int>(unit::kPhases));
  program.set("swapped", composition.swapped ? 1 : 0);
  program.set("picture", width, height);
  program.set("image", images.width(), images.height());
  program.set("nodes_per_pixel", 1.0F / drivers::display::PhaseMap::kStep);
  program.set("subpixel", static_cast<float>(composition.subpixel));
  program.set("leak", static_cast<float>(composition.leak[0]), static_cast<float>(composition.leak[1]));
  program.set("gamma", static_cast<float>(composition.gamma));
  glBindVertexArray(no_attributes_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glActiveTexture(GL_TEXTURE0);
  return {};
}

}  // namespace prismesh::kiosk::render
