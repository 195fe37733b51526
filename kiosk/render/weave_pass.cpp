#include "kiosk/render/weave_pass.h"

namespace prismesh::kiosk::render {

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

void WeavePass::draw(const Composition& composition, const EyeImages& images, unsigned framebuffer, int width, int height) {
  if (composition.phases.columns > 0) upload(composition.phases);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  images.bind_texture(0, unit::kLeft);
  images.bind_texture(composition.images.size() > 1 ? 1 : 0, unit::kRight);
  const gl::Program& program = shaders_.weave;
  program.use();
  program.set("left_eye", static_cast<int>(unit::kLeft));
  program.set("right_eye", static_cast<int>(unit::kRight));
  program.set("phases", static_cast<int>(unit::kPhases));
  program.set("join", static_cast<int>(composition.join));
  program.set("by_rows", composition.by_rows ? 1 : 0);
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
}

}  // namespace prismesh::kiosk::render
