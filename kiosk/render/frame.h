// Viewpoint and projection of one image, and the uniforms that all its draws share.
#pragma once

#include "kiosk/render/draw_span.h"
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
  /// Distance of the viewer from the screen, the same for both eyes, so that what keeps its size on the screen is the same solid for both.
  double viewer_mm = 650;
};

/// Limits of a mark's radius on the screen.
struct RadiusLimits {
  float max_pixels = 0;
  float min_pixels = 0;
  float share_of_side = 0;  ///< radius over the side of a typical element
};

struct Frame {
  const EyeView& eye;
  const stereo::View& view;
  DrawSpan& span;  ///< which of its draws are made
  Eigen::Matrix4d clip_from_deck;
  Eigen::Matrix4f clip_from_model;  ///< model coordinates are relative to the model's origin
  Eigen::Matrix4f screen_from_model;
  Eigen::Matrix3f screen_from_normal;
  Eigen::Vector3f eye_in_model;
  Eigen::Vector4f cut;  ///< cut_plane
  /// By which marks on mid-surfaces are moved toward the eye, so that the shells' own plates don't hide them; 0: no plates are drawn.
  float over_plates_mm = 0;
  // Maps between steps on the display (pixels, y up), in normalised coordinates and in texels of the image.
  Eigen::Matrix2f clip_from_pixels, pixels_from_clip, texels_from_pixels, pixels_from_texels;

  Frame(const EyeView& eye_view, const Picture& picture, const ModelLayer& model, DrawSpan& drawn);

  /// Radius in pixels of a mark on a node or shell: limits.share_of_side of the typical side, within the limits; without such a side the
  /// max.
  float fitting_radius(const RadiusLimits& limits, double typical_side) const;
  /// Makes the program current and sets the uniforms of programs that read the model's textures.
  void set(const gl::Program& program) const;
};

/// The plane of the model's cut, relative to the model's origin: times (x, y, z, 1) it is below 0 where the model is cut away.
Eigen::Vector4f cut_plane(const ModelLayer& model);

/// Size in mm, at depth z_mm, of what covers a display pixel for a viewer at the distance viewer_mm from the screen.
inline double mm_of_pixel_at(double mm_per_pixel, double viewer_mm, double z_mm) {
  return mm_per_pixel * std::max(viewer_mm - z_mm, 1.0) / std::max(viewer_mm, 1.0);
}

/// Maps texels of an image (from its lower left corner) to pixels of the picture (from its upper left corner).
Eigen::Matrix3d picture_from(const EyeImage& image);

/// Whether a box may be visible: false only if all its corners are outside the same plane of the view volume.
bool may_be_seen(const stereo::Box& box, const Eigen::Matrix4d& clip_from_deck);

inline Eigen::Vector4f ink(const Colour& colour, float alpha) { return {colour.x(), colour.y(), colour.z(), alpha}; }

/// Turns on blending by alpha.
void blend_by_alpha();

}  // namespace prismesh::kiosk::render
