#include "kiosk/render/frame.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "kiosk/render/shaders.h"

namespace prismesh::kiosk::render {

namespace {

/// Of the largest half thickness: enough for what is seen at up to 60 degrees from its normal. A sheet that lies against another one stays
/// behind it: their mid-surfaces are two half thicknesses apart, and the outer face is one more away.
constexpr double kOverPlates = 2;

}  // namespace

Eigen::Matrix3d picture_from(const EyeImage& image) {
  Eigen::Matrix3d from_texels, to_picture = Eigen::Matrix3d::Identity();
  from_texels << 2.0 / image.width, 0, -1, 0, 2.0 / image.height, -1, 0, 0, 1;
  to_picture.topRows<2>() = image.from_picture;
  return to_picture.inverse() * from_texels;
}

Frame::Frame(const EyeView& eye_view, const Picture& picture, const ModelLayer& model, DrawSpan& drawn)
    : eye(eye_view), view(picture.view), span(drawn) {
  const Eigen::Matrix4d screen_from_deck = stereo::screen_from_deck(view);
  clip_from_deck = eye.clip_from_screen * screen_from_deck;
  Eigen::Matrix4d deck_from_model = Eigen::Matrix4d::Identity();
  deck_from_model.topRightCorner<3, 1>() = model.textures().origin();
  clip_from_model = (clip_from_deck * deck_from_model).cast<float>();
  screen_from_model = (screen_from_deck * deck_from_model).cast<float>();
  screen_from_normal = view.rotation.toRotationMatrix().cast<float>();
  cut = cut_plane(model);
  if (picture.thickness)  // a single thick part mustn't make marks shine through others
    over_plates_mm =
        static_cast<float>(kOverPlates * view.mm_per_unit * std::min(0.5 * model.plates().max_thickness(), model.typical_side()));
  eye_in_model = (stereo::to_deck(view, eye.eye_mm) - model.textures().origin()).cast<float>();
  const Eigen::Matrix2d clip = eye.image.from_picture.leftCols<2>() * Eigen::Vector2d(1, -1).asDiagonal();
  const Eigen::Matrix2d texels = 0.5 * Eigen::Vector2d(eye.image.width, eye.image.height).asDiagonal() * clip;
  clip_from_pixels = clip.cast<float>();
  pixels_from_clip = clip.inverse().cast<float>();
  texels_from_pixels = texels.cast<float>();
  pixels_from_texels = texels.inverse().cast<float>();
}

Eigen::Vector4f cut_plane(const ModelLayer& model) {
  if (!model.cut()) return {0, 0, 0, 1};
  const CutPicture& cut = *model.cut();
  Eigen::Vector4d plane;
  plane << -cut.normal, (cut.point - model.textures().origin()).dot(cut.normal);
  return plane.cast<float>();
}

float Frame::fitting_radius(const RadiusLimits& limits, double typical_side) const {
  if (typical_side <= 0) return limits.max_pixels;
  const double side_pixels = typical_side * view.mm_per_unit / eye.mm_per_pixel;
  const float wanted = limits.share_of_side * static_cast<float>(std::min(side_pixels, 1000.0));
  return std::clamp(wanted, limits.min_pixels, limits.max_pixels);
}

void Frame::set(const gl::Program& program) const {
  program.use();
  const double n = eye.range.near_mm, f = eye.range.far_mm;
  program.set("clip_from_model", clip_from_model);
  program.set("depth_terms", static_cast<float>((f + n) / (f - n)), static_cast<float>(2 * f * n / (f - n)));
  program.set("positions", static_cast<int>(unit::kPositions));
  program.set("connectivity", static_cast<int>(unit::kConnectivity));
  program.set("surface", static_cast<int>(unit::kSurface));
  program.set("lines", static_cast<int>(unit::kLines));
  program.set("clip_from_pixels", clip_from_pixels);
  program.set("pixels_from_clip", pixels_from_clip);
  program.set("texels_from_pixels", texels_from_pixels);
  program.set("pixels_from_texels", pixels_from_texels);
  program.set("mm_per_pixel", static_cast<float>(eye.mm_per_pixel));
  program.set("screen_from_normal", screen_from_normal);
  program.set("screen_from_model", screen_from_model);
  program.set("clip_from_screen", Eigen::Matrix4f(eye.clip_from_screen.cast<float>()));
  program.set("viewer_mm", static_cast<float>(eye.viewer_mm));
  program.set("cut_plane", cut);
  program.set("over_plates_mm", over_plates_mm);
}

bool may_be_seen(const stereo::Box& box, const Eigen::Matrix4d& clip_from_deck) {
  if (box.empty()) return false;
  unsigned outside_of_all = 0x3f;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector4d at((corner & 1 ? box.high : box.low).x(), (corner & 2 ? box.high : box.low).y(),
                             (corner & 4 ? box.high : box.low).z(), 1);
    const Eigen::Vector4d clip = clip_from_deck * at;
    unsigned outside = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (clip[axis] < -clip.w()) outside |= 1U << (2 * axis);
      if (clip[axis] > clip.w()) outside |= 2U << (2 * axis);
    }
    outside_of_all &= outside;
  }
  return outside_of_all == 0;
}

void blend_by_alpha() {
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

}  // namespace prismesh::kiosk::render
