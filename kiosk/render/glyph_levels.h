// Thins glyphs out where they would lie on each other: which of them are shown at which distance. No OpenGL.
#pragma once

#include <vector>

#include "kiosk/render/glyph_shape.h"
#include "kiosk/render/model_table.h"

namespace prismesh::kiosk::render {

/// Sets the level of each glyph (kGlyphLevelShift). Space is divided into cells of 2^e; of the glyphs in a cell the last of the list stays,
/// as failures come last, so a glyph's level is the largest e at which it is the last in its cell. All glyphs of a shell have one level,
/// and a cluster, which stands at a node, has its own. `least`: the edge of the smallest cells that can matter, deck's unit; below it all
/// stay. Costs the glyphs.
void set_glyph_levels(const ModelTable& table, double least, std::vector<Glyph>& glyphs);

/// The level that a glyph must have to be shown, so that shown ones are about `spacing` apart (deck's unit).
std::uint32_t needed_glyph_level(double spacing);

}  // namespace prismesh::kiosk::render
