// GLSL text of what editing adds to the picture: selected nodes, handle, rubber band, lasso, shadows. shaders.cpp compiles and links it.
#pragma once

namespace prismesh::kiosk::render {

extern const char* const kNodeVertex;
extern const char* const kNodeFragment;
extern const char* const kHandleVertex;
extern const char* const kHandleFragment;
extern const char* const kRectangleFragment;
extern const char* const kScreenLineVertex;
extern const char* const kScreenLineFragment;
extern const char* const kShadowCasterVertex;
extern const char* const kShadowCasterFragment;
extern const char* const kShadowPlaneVertex;
extern const char* const kShadowPlaneFragment;

}  // namespace prismesh::kiosk::render
