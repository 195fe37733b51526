// From where and onto what an image is drawn, and what all the draws of one image share.
#pragma once

#include "kiosk/render/gl.h"
#include "kiosk/render/model_layer.h"
#include "kiosk/render/palette.h"
#include "kiosk/render/picture.h"

namespace prismesh::kiosk::render {

struct EyeView {
  Vec3 eye_mm = Vec3(0, 0, 650);
  Eigen::Matrix4d clip_from_screen = Eigen::Matrix4d::Identity();  ///< onto the image
  stereo::DepthRange range;
  EyeImage image;
  double mm_per_pixel = 0.28;  ///< of the display
  /// Before the screen, the same for both eyes: what keeps its size on the screen is then the same solid for both.
  double viewer_mm = 650;
};

struct Frame {
  const EyeView& eye;
  const stereo::View& view;
  Eigen::Matrix4d clip_from_deck;
  Eigen::Matrix4f clip_from_model;  ///< the model's coordinates count from its origin
  Eigen::Matrix4f screen_from_model;
  Eigen::Matrix3f screen_from_normal;
  Eigen::Vector3f eye_in_model;
  // Steps on the display (pixels, y up), in normalised coordinates and in texels.
  Eigen::Matrix2f clip_from_pixels, pixels_from_clip, texels_from_pixels, pixels_from_texels;

  Frame(const EyeView& eye_view, const Picture& picture, const ModelLayer& model);

  /// A sign's radius in pixels: `largest` unless that crowds typical elements.
  float fitting_radius(float largest, float least, float share, double typical_side) const;
  /// What every program that pulls the model needs. Uses the program.
  void set(const gl::Program& program) const;
};

/// Millimetres that a display pixel measures at a depth, for a viewer at a distance from the screen.
inline double mm_of_pixel_at(double mm_per_pixel, double viewer_mm, double z_mm) {
  return mm_per_pixel * std::max(viewer_mm - z_mm, 1.0) / std::max(viewer_mm, 1.0);
}

/// An image's places (texels from its lower left corner) to the picture's (pixels from the upper left corner).
Eigen::Matrix3d picture_from(const EyeImage& image);

/// Whether a box may be seen: false only if all its corners are outside one side of the picture.
bool may_be_seen(const stereo::Box& box, const Eigen::Matrix4d& clip_from_deck);

inline Eigen::Vector4f ink(const Colour& colour, float alpha) { return {colour.x(), colour.y(), colour.z(), alpha}; }

/// Blending by the ink's alpha from now on.
void blend_by_alpha();

}  // namespace prismesh::kiosk::render
