// GLSL text of the texture on shells that touch; shaders.cpp compiles and links it.
#pragma once

namespace prismesh::kiosk::render {

extern const char* const kAlertVertex;
extern const char* const kAlertFragment;

}  // namespace prismesh::kiosk::render
