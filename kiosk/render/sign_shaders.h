// What the shaders of signs, handles and lines over the picture say; shaders.cpp links them.
#pragma once

namespace prismesh::kiosk::render::sign_shaders {

/// The corners (-1 or 1) of a square's two triangles: what each of six vertices has.
extern const char* const kSquareCorner;
extern const char* const kNodeVertex;
extern const char* const kNodeFragment;
extern const char* const kGlyphVertex;
extern const char* const kGlyphFragment;
extern const char* const kHandleVertex;
extern const char* const kHandleFragment;
extern const char* const kRectangleFragment;
extern const char* const kPencilVertex;
extern const char* const kPencilFragment;
extern const char* const kShadowCasterVertex;
extern const char* const kShadowCasterFragment;
extern const char* const kShadowPlaneVertex;
extern const char* const kShadowPlaneFragment;

}  // namespace prismesh::kiosk::render::sign_shaders
