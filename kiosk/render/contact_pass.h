// Draws the alerting texture on shells that touch.
#pragma once

#include "kiosk/render/frame.h"
#include "kiosk/render/model_layer.h"
#include "kiosk/render/shaders.h"

namespace prismesh::kiosk::render {

/// Stripes are this many display pixels wide at least, and at most twice as wide: a bright and a dark one are a period.
inline constexpr double kStripePixels = 6;
/// The period of the stripes in the model, deck's length unit: a power of two, so that they stay where they are while the view grows.
double stripe_period(double mm_per_unit, double mm_per_pixel);

class ContactPass {
 public:
  explicit ContactPass(const Shaders& shaders) : shaders_(shaders), no_attributes_(gl::VertexArray::make()) {}

  /// On the surface, which must have been drawn. Those of the chosen region and of a drag are seen, fainter, through what hides them.
  void draw(const ModelLayer& model, const Frame& frame) const;

 private:
  void draw_shells(const ContactMarks::Shells& shells, const RowTexture& positions, float alpha, DrawSpan& span) const;

  const Shaders& shaders_;
  gl::VertexArray no_attributes_;
};

}  // namespace prismesh::kiosk::render
