// GLSL text of the quality glyphs; shaders.cpp compiles and links it. docs/drawing.md describes the shapes.
#pragma once

namespace prismesh::kiosk::render {

extern const char* const kGlyphVertex;
extern const char* const kGlyphFragment;

}  // namespace prismesh::kiosk::render
