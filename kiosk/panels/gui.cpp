#include "kiosk/panels/gui.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <imgui.h>
#include <imgui_internal.h>

#include "kiosk/panels/gui_renderer.h"

namespace prismesh::kiosk::panels {
namespace {

using display::Key;

constexpr const char* kFontFile = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

// Latin, Greek, Cyrillic, punctuation, arrows, mathematical signs and geometric shapes.
constexpr std::array<ImWchar, 15> kGlyphs = {0x20,   0x24f,  0x370,  0x52f,  0x2010, 0x205e, 0x2190, 0x21ff,
                                             0x2200, 0x22ff, 0x25a0, 0x25ff, 0x2713, 0x2717, 0};

constexpr std::array<std::pair<ImGuiKey_, Key>, 16> kKeys = {{{ImGuiKey_Tab, Key::tab},
                                                              {ImGuiKey_LeftArrow, Key::left},
                                                              {ImGuiKey_RightArrow, Key::right},
                                                              {ImGuiKey_UpArrow, Key::up},
                                                              {ImGuiKey_DownArrow, Key::down},
                                                              {ImGuiKey_Home, Key::home},
                                                              {ImGuiKey_End, Key::end},
                                                              {ImGuiKey_Delete, Key::remove},
                                                              {ImGuiKey_Backspace, Key::backspace},
                                                              {ImGuiKey_Enter, Key::enter},
                                                              {ImGuiKey_Escape, Key::escape},
                                                              {ImGuiKey_A, display::letter('A')},
                                                              {ImGuiKey_C, display::letter('C')},
                                                              {ImGuiKey_V, display::letter('V')},
                                                              {ImGuiKey_X, display::letter('X')},
                                                              {ImGuiKey_Z, display::letter('Z')}}};

void set_style() {
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowPadding = ImVec2(2 * kGrid, 2 * kGrid);
  style.FramePadding = ImVec2(kGrid, kGrid / 2);
  style.ItemSpacing = ImVec2(kGrid, kGrid);
  style.ItemInnerSpacing = ImVec2(kGrid, kGrid / 2);
  style.CellPadding = ImVec2(kGrid / 2, kGrid / 4);
  style.ScrollbarSize = kGrid;
  style.WindowRounding = kGrid / 2;
  style.FrameRounding = kGrid / 2;
  style.ScrollbarRounding = kGrid / 2;
  style.WindowBorderSize = 0;
  style.FrameBorderSize = 0;
  style.DisabledAlpha = 0.45f;
  ImVec4* colour = style.Colors;
  const ImVec4 ink = ImGui::ColorConvertU32ToFloat4(kInk);
  colour[ImGuiCol_Text] = ink;
  colour[ImGuiCol_TextDisabled] = ImGui::ColorConvertU32ToFloat4(kFaintInk);
  colour[ImGuiCol_WindowBg] = ImGui::ColorConvertU32ToFloat4(kPanelColour);
  colour[ImGuiCol_ChildBg] = ImVec4(0, 0, 0, 0);
  colour[ImGuiCol_PopupBg] = colour[ImGuiCol_MenuBarBg] = colour[ImGuiCol_WindowBg];
  colour[ImGuiCol_Border] = ImGui::ColorConvertU32ToFloat4(kBorderColour);
  colour[ImGuiCol_Tab] = colour[ImGuiCol_TabUnfocused] = ImVec4(0, 0, 0, 0);
  colour[ImGuiCol_TabHovered] = ImVec4(1, 1, 1, 0.18f);
  colour[ImGuiCol_TabActive] = colour[ImGuiCol_TabUnfocusedActive] = ImVec4(1, 1, 1, 0.14f);
  colour[ImGuiCol_FrameBg] = ImVec4(1, 1, 1, 0.08f);
  colour[ImGuiCol_FrameBgHovered] = ImVec4(1, 1, 1, 0.13f);
  colour[ImGuiCol_FrameBgActive] = ImVec4(1, 1, 1, 0.16f);
  colour[ImGuiCol_Button] = ImVec4(1, 1, 1, 0.10f);
  colour[ImGuiCol_ButtonHovered] = ImVec4(1, 1, 1, 0.18f);
  colour[ImGuiCol_ButtonActive] = ImVec4(1, 1, 1, 0.26f);
  colour[ImGuiCol_Header] = ImVec4(1, 1, 1, 0.10f);
  colour[ImGuiCol_HeaderHovered] = ImVec4(1, 1, 1, 0.14f);
  colour[ImGuiCol_HeaderActive] = ImVec4(1, 1, 1, 0.20f);
  colour[ImGuiCol_Separator] = ImVec4(1, 1, 1, 0.14f);
  colour[ImGuiCol_ScrollbarBg] = ImVec4(0, 0, 0, 0);
  colour[ImGuiCol_ScrollbarGrab] = ImVec4(1, 1, 1, 0.20f);
  colour[ImGuiCol_ScrollbarGrabHovered] = ImVec4(1, 1, 1, 0.28f);
  colour[ImGuiCol_ScrollbarGrabActive] = ImVec4(1, 1, 1, 0.36f);
  colour[ImGuiCol_CheckMark] = ink;
  colour[ImGuiCol_PlotHistogram] = ImGui::ColorConvertU32ToFloat4(kInformationColour);
  colour[ImGuiCol_TextSelectedBg] = ImVec4(0.41f, 0.71f, 0.93f, 0.35f);
  colour[ImGuiCol_NavHighlight] = ImGui::ColorConvertU32ToFloat4(kInformationColour);
}

void set_modifiers(const display::Modifiers& modifiers) {
  ImGuiIO& io = ImGui::GetIO();
  io.KeyShift = modifiers.shift;
  io.KeyCtrl = modifiers.ctrl;
  io.KeyAlt = modifiers.alt;
}

void move_pointer(double x, double y) { ImGui::GetIO().MousePos = ImVec2(static_cast<float>(x), static_cast<float>(y)); }

int button_number(display::MouseButton button) {
  return button == display::MouseButton::left    ? ImGuiMouseButton_Left
         : button == display::MouseButton::right ? ImGuiMouseButton_Right
                                                 : ImGuiMouseButton_Middle;
}

struct Feed {
  // Keys aren't enough: that of Shift itself comes with the modifiers of the moment before.
  void operator()(const display::PointerMoved& event) const {
    move_pointer(event.x, event.y);
    set_modifiers(event.modifiers);
  }
  void operator()(const display::ButtonChanged& event) const {
    move_pointer(event.x, event.y);
    set_modifiers(event.modifiers);
    ImGui::GetIO().MouseDown[button_number(event.button)] = event.down;
  }
  void operator()(const display::WheelTurned& event) const {
    move_pointer(event.x, event.y);
    ImGui::GetIO().MouseWheel += static_cast<float>(event.steps);
  }
  void operator()(const display::KeyChanged& event) const {
    set_modifiers(event.modifiers);
    ImGui::GetIO().KeysDown[static_cast<int>(event.key)] = event.down;
  }
  void operator()(const display::TextTyped& event) const { ImGui::GetIO().AddInputCharactersUTF8(event.text.c_str()); }
  void operator()(const display::PointerLeft&) const { ImGui::GetIO().MousePos = ImVec2(-FLT_MAX, -FLT_MAX); }
  void operator()(const display::FocusGained&) const {}
  void operator()(const display::FocusLost&) const {
    std::fill(std::begin(ImGui::GetIO().KeysDown), std::end(ImGui::GetIO().KeysDown), false);
    std::fill(std::begin(ImGui::GetIO().MouseDown), std::end(ImGui::GetIO().MouseDown), false);
    set_modifiers({});
  }
  template <class Other>
  void operator()(const Other&) const {}
};

}  // namespace

struct Gui::Impl {
  ImGuiContext* context = nullptr;
  std::optional<GuiRenderer> renderer;
  TypeSizes type;
  bool laid_out = false;
  std::string clipboard;
  std::optional<std::string> copied;

  Impl() : context(ImGui::CreateContext()) { ImGui::SetCurrentContext(context); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    renderer.reset();
    ImGui::DestroyContext(context);
  }
};

TypeSizes type_for(display::PixelSize picture, bool stereo) {
  constexpr double kUsualWidth = 1920, kUsualHeight = 1080;
  const double scale = std::min(picture.width / kUsualWidth, picture.height / kUsualHeight);
  const TypeSizes usual = stereo ? kStereoType : kFlatType;
  // Quarters, so that a window that is resized doesn't make a font of each size.
  const double quarters = std::clamp(std::floor(4 * scale), stereo ? 3.0 : 4.0, 12.0);
  const auto sized = [&](float size) { return static_cast<float>(std::round(static_cast<double>(size) * quarters / 4)); };
  return {sized(usual.small), sized(usual.body), sized(usual.title)};
}

Gui::Gui(std::unique_ptr<Impl> state) : impl_(std::move(state)) {}
Gui::Gui(Gui&&) noexcept = default;
Gui& Gui::operator=(Gui&&) noexcept = default;
Gui::~Gui() = default;

Result<Gui> Gui::create() {
  Gui gui(std::make_unique<Impl>());
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendRendererName = "prismesh";
  io.ClipboardUserData = gui.impl_.get();
  io.GetClipboardTextFn = [](void* state) { return static_cast<const Impl*>(state)->clipboard.c_str(); };
  io.SetClipboardTextFn = [](void* state, const char* text) {
    auto& impl = *static_cast<Impl*>(state);
    impl.clipboard = text;
    impl.copied = impl.clipboard;
  };
  for (const auto& [theirs, ours] : kKeys) io.KeyMap[theirs] = static_cast<int>(ours);
  set_style();
  if (Result<void> type = gui.set_type(kFlatType); !type) return fail(type.error());
  Result<GuiRenderer> renderer = GuiRenderer::create();
  if (!renderer) return fail(renderer.error());
  gui.impl_->renderer = std::move(*renderer);
  return gui;
}

TypeSizes for_fingers(const TypeSizes& sizes, double pixel_pitch_mm) {
  constexpr float kLeastBody = 24;
  constexpr double kTargetMm = 15, kLinesOfTarget = 2.5;
  const auto for_target = static_cast<float>(std::ceil(kTargetMm / kLinesOfTarget / std::max(pixel_pitch_mm, 0.05)));
  const float scale = std::max(1.0F, std::max(kLeastBody, for_target) / sizes.body);
  return {std::round(sizes.small * scale), std::round(sizes.body * scale), std::round(sizes.title * scale)};
}

Result<void> Gui::set_type(const TypeSizes& sizes) {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  if (fonts.Fonts.Size > 0 && sizes == impl_->type) return {};
  if (std::error_code error; !std::filesystem::exists(kFontFile, error))
    return fail(kFontFile, "the panels' font is missing: install fonts-dejavu-core");
  fonts.Clear();
  ImFontConfig config;
  config.OversampleH = 1;  // glyphs start on whole pixels, so that half-width images average exactly two of them
  config.PixelSnapH = true;
  for (const float size : {sizes.body, sizes.small, sizes.title})
    if (fonts.AddFontFromFileTTF(kFontFile, size, &config, kGlyphs.data()) == nullptr)
      return fail(kFontFile, "not a font that can be read: install fonts-dejavu-core again");
  fonts.Build();
  impl_->type = sizes;
  if (impl_->renderer) impl_->renderer->upload_fonts();
  return {};
}

const TypeSizes& Gui::type() const { return impl_->type; }

void Gui::feed(const display::WindowEvent& event) { std::visit(Feed{}, event); }

bool Gui::popup_open() const { return !impl_->context->OpenPopupStack.empty(); }

void Gui::close_popups() {
  if (popup_open()) ImGui::ClosePopupToLevel(0, true);
}

bool Gui::on_panel(double x, double y) const {
  if (popup_open()) return true;
  for (const ImGuiWindow* window : impl_->context->Windows) {
    // NoInputs would be wrong: it holds the flags of the keyboard's navigation too, which no panel has.
    if (!window->WasActive || window->Hidden || (window->Flags & ImGuiWindowFlags_NoMouseInputs) != 0) continue;
    if (window->Rect().Contains(ImVec2(static_cast<float>(x), static_cast<float>(y)))) return true;
  }
  return false;
}

bool Gui::holds_pointer() const { return ImGui::IsAnyItemActive() && ImGui::IsAnyMouseDown(); }

bool Gui::wants_keys() const { return ImGui::GetIO().WantTextInput; }

void Gui::set_clipboard(const std::string& text) { impl_->clipboard = text; }

std::optional<std::string> Gui::take_copied() { return std::exchange(impl_->copied, std::nullopt); }

void Gui::layout(display::PixelSize picture, double seconds, const std::function<void()>& build) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(picture.width), static_cast<float>(picture.height));
  io.DeltaTime = static_cast<float>(std::clamp(seconds, 1e-4, 0.25));
  ImGui::NewFrame();
  build();
  ImGui::Render();
  impl_->laid_out = true;
}

void Gui::draw(display::PixelSize target, const PictureMap& from_picture) const {
  if (impl_->laid_out) impl_->renderer->draw(*ImGui::GetDrawData(), target, from_picture);
}

void draw_pointer(double x, double y) {
  const auto at = [&](float dx, float dy) { return ImVec2(static_cast<float>(x) + dx, static_cast<float>(y) + dy); };
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const std::array<ImVec2, 4> arrow{at(0, 0), at(0, 26), at(7, 19), at(18, 18)};
  list.AddTriangleFilled(arrow[0], arrow[1], arrow[2], kInk);
  list.AddTriangleFilled(arrow[0], arrow[2], arrow[3], kInk);
  list.AddPolyline(arrow.data(), static_cast<int>(arrow.size()), 0xff262422, ImDrawFlags_Closed, 2);
}

ImFont* small_font() { return ImGui::GetIO().Fonts->Fonts[1]; }
ImFont* title_font() { return ImGui::GetIO().Fonts->Fonts[2]; }

}  // namespace prismesh::kiosk::panels
