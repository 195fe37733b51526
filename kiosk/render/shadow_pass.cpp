#include "kiosk/render/shadow_pass.h"

namespace prismesh::kiosk::render {

namespace {

constexpr int kMaskSize = 384;
const Colour kShadowColour{0.13F, 0.14F, 0.16F};
const Colour kPlaneColour{0.62F, 0.63F, 0.65F};

/// A plane's lower corner and sides, relative to the model's origin.
struct Sides {
  Eigen::Vector3f corner, u, v;
};
Sides sides_of(const ShadowPlane& plane, const mesh::Vec3& origin) {
  const mesh::Vec3 size = plane.high - plane.low;
  mesh::Vec3 u = mesh::Vec3::Zero(), v = mesh::Vec3::Zero();
  const int first = (plane.axis + 1) % 3, second = (plane.axis + 2) % 3;
  u[first] = size[first];
  v[second] = size[second];
  return {(plane.low - origin).cast<float>(), u.cast<float>(), v.cast<float>()};
}

}  // namespace

ShadowPass::ShadowPass(const Shaders& shaders) : shaders_(shaders), no_attributes_(gl::VertexArray::make()) {}

std::size_t ShadowPass::bytes_held() const {
  std::size_t bytes = 0;
  for (const Cast& cast : casts_) bytes += cast.mask ? std::size_t{kMaskSize} * kMaskSize : 0;
  return bytes;
}

std::size_t ShadowPass::max_bytes() { return std::size_t{3} * kMaskSize * kMaskSize; }

Result<void> ShadowPass::cast(ModelLayer& model, const stereo::View& view) {
  count_ = 0;
  if (model.empty()) return {};
  const Result<ModelLayer::ShadowCaster> caster = model.shadow_caster();
  if (!caster) return fail(caster.error());
  if (caster->shells == 0) return {};
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  for (const ShadowPlane& plane : shadow_planes(model.shown_box(), view)) {
    Cast& cast = casts_[count_++];
    cast.plane = plane;
    if (!cast.mask) {
      cast.mask = gl::Texture::make();
      glBindTexture(GL_TEXTURE_2D, cast.mask.get());
      glTexStorage2D(GL_TEXTURE_2D, 1, GL_R8, kMaskSize, kMaskSize);
      for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(GL_TEXTURE_2D, name, GL_LINEAR);
      for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, name, GL_CLAMP_TO_EDGE);
      cast.framebuffer = gl::Framebuffer::make();
      glBindFramebuffer(GL_FRAMEBUFFER, cast.framebuffer.get());
      glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, cast.mask.get(), 0);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, cast.framebuffer.get());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      return fail("OpenGL", "there is no graphics memory for shadows");
    glViewport(0, 0, kMaskSize, kMaskSize);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    caster->positions->bind(unit::kPositions);
    caster->connectivity->bind(unit::kConnectivity);
    const Sides sides = sides_of(plane, model.textures().origin());
    const gl::Program& program = shaders_.shadow_caster;
    program.use();
    program.set("positions", static_cast<int>(unit::kPositions));
    program.set("connectivity", static_cast<int>(unit::kConnectivity));
    program.set("corner", sides.corner);
    program.set("along_u", Eigen::Vector3f(sides.u / sides.u.squaredNorm()));
    program.set("along_v", Eigen::Vector3f(sides.v / sides.v.squaredNorm()));
    glBindVertexArray(no_attributes_.get());
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(caster->shells * 6));
  }
  return {};
}

void ShadowPass::draw(const ModelLayer& model, const Frame& frame) const {
  if (count_ == 0) return;
  frame.set(shaders_.shadow_plane);
  const gl::Program& program = shaders_.shadow_plane;
  program.set("shadow", static_cast<int>(unit::kSelection));
  program.set("shadow_ink", kShadowColour);
  program.set("plane_ink", kPlaneColour);
  program.set("step", 1.0F / kMaskSize);
  blend_by_alpha();
  glDepthMask(GL_FALSE);
  glBindVertexArray(no_attributes_.get());
  for (std::size_t i = 0; i < count_; ++i) {
    const Sides sides = sides_of(casts_[i].plane, model.textures().origin());
    program.set("corner", sides.corner);
    program.set("side_u", sides.u);
    program.set("side_v", sides.v);
    glActiveTexture(GL_TEXTURE0 + unit::kSelection);
    glBindTexture(GL_TEXTURE_2D, casts_[i].mask.get());
    glDrawArrays(GL_TRIANGLES, 0, 6);
  }
  glDepthMask(GL_TRUE);
}

}  // namespace prismesh::kiosk::render
