#include "kiosk/render/palette.h"

namespace prismesh::kiosk::render {

namespace {

std::array<Colour, kPartColours> make_part_colours() {
  const std::array<Colour, 7> okabe_ito{Colour(230, 159, 0), Colour(86, 180, 233), Colour(0, 158, 115),  Colour(240, 228, 66),
                                        Colour(0, 114, 178), Colour(213, 94, 0),   Colour(204, 121, 167)};
  // Share of the pure hue, the rest is a warm white: one for each round of seven parts.
  const std::array<float, 3> strength{0.50F, 0.30F, 0.66F};
  const Colour white(0.96F, 0.95F, 0.93F);
  std::array<Colour, kPartColours> colours;
  for (std::size_t i = 0; i < 21; ++i) colours[i] = strength[i / 7] * okabe_ito[i % 7] / 255.0F + (1 - strength[i / 7]) * white;
  colours[kColourOfNoPart] = Colour(0.80F, 0.80F, 0.79F);
  return colours;
}

}  // namespace

const std::array<Colour, kPartColours>& part_colours() {
  static const std::array<Colour, kPartColours> colours = make_part_colours();
  return colours;
}

const std::array<Colour, 3>& grade_colours() {
  static const std::array<Colour, 3> colours{Colour(0.80F, 0.82F, 0.83F), Colour(0.97F, 0.82F, 0.30F), Colour(0.90F, 0.30F, 0.25F)};
  return colours;
}

}  // namespace prismesh::kiosk::render
