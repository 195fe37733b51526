#include "kiosk/input/mouse_layout.h"

#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>

#include <toml++/toml.h>

#include "base/file.h"
#include "base/nearest_name.h"

namespace prismesh::kiosk::input {

namespace {

using display::Modifiers;
using display::MouseButton;

constexpr std::array<std::string_view, 3> kButtons{"left", "middle", "right"};
constexpr std::array<std::string_view, 6> kDrags{"outline", "remove-outline", "other-outline", "orbit", "pan", "zoom"};
constexpr std::array<std::string_view, 6> kDragMeanings{"select what an outline goes round: a lasso, or a rectangle (L changes that)",
                                                        "take what an outline goes round out of the selection",
                                                        "the same with the other kind of outline",
                                                        "orbit",
                                                        "pan",
                                                        "zoom"};
constexpr std::array<std::string_view, 5> kClicks{"nothing", "pick", "unpick", "take-back", "region"};
constexpr std::array<std::string_view, 5> kClickMeanings{
    "nothing", "select the nearest visible node; in the empty ground: clear the selection",
    "remove the nearest visible node from the selection; where it is not selected: the menu of what is under the pointer",
    "take back the last selection step", "select the region around the node: up to creases, its part, its piece or its free edge"};
constexpr std::array<std::string_view, 2> kWheels{"zoom", "angle"};
constexpr std::array<std::string_view, 2> kWheelMeanings{"zoom to the pointer", "widen or narrow the angle that bounds regions"};

std::string in_words(const Modifiers& modifiers) {
  return std::string(modifiers.ctrl ? "Ctrl+" : "") + (modifiers.alt ? "Alt+" : "") + (modifiers.shift ? "Shift+" : "");
}

/// "ctrl+left": the modifiers go, what is left is returned.
std::string_view without_modifiers(std::string_view text, Modifiers& modifiers) {
  for (bool found = true; found;) {
    found = false;
    const auto take = [&](std::string_view name, bool& flag) {
      if (!text.starts_with(name) || flag) return;
      flag = found = true;
      text.remove_prefix(name.size());
    };
    take("alt+", modifiers.alt);
    take("ctrl+", modifiers.ctrl);
    take("shift+", modifiers.shift);
  }
  return text;
}

}  // namespace

class MouseReader {
 public:
  explicit MouseReader(std::string file) : file_(std::move(file)) {}

  Result<MouseLayout> read(const toml::table& root) const {
    MouseLayout layout;
    constexpr std::array<std::string_view, 4> kSections{"drag", "click", "double-click", "wheel"};
    constexpr std::array<std::string_view, 1> kWheel{"wheel"};
    for (const auto& [name, node] : root) {
      const toml::table* table = node.as_table();
      const auto section = std::find(kSections.begin(), kSections.end(), name.str());
      if (section == kSections.end() || table == nullptr)
        return wrong(node, "a mouse layout has no section [" + std::string(name.str()) + "]; the nearest known is [" +
                               std::string(nearest_name(name.str(), kSections)) + "]");
      const auto which = section - kSections.begin();
      const Result<void> done = which == 0   ? bindings<DragDoes>(*table, kButtons, kDrags, layout.drags_)
                                : which == 1 ? bindings<ClickDoes>(*table, kButtons, kClicks, layout.clicks_)
                                : which == 2 ? bindings<ClickDoes>(*table, kButtons, kClicks, layout.double_clicks_)
                                             : bindings<WheelDoes>(*table, kWheel, kWheels, layout.wheels_);
      if (!done) return fail(done.error());
    }
    return complete(std::move(layout));
  }

 private:
  tl::unexpected<Error> wrong(const toml::node& at, std::string message) const {
    return fail(file_, static_cast<long>(at.source().begin.line), std::move(message));
  }

  template <class Does>
  Result<void> bindings(const toml::table& table, std::span<const std::string_view> buttons, std::span<const std::string_view> deeds,
                        std::vector<MouseLayout::Binding<Does>>& out) const {
    for (const auto& [key, value] : table) {
      MouseLayout::Binding<Does> binding;
      const std::string_view button = without_modifiers(key.str(), binding.modifiers);
      const auto which = std::find(buttons.begin(), buttons.end(), button);
      if (which == buttons.end())
        return wrong(value, "\"" + std::string(key.str()) + "\" is no button; the nearest is \"" +
                                std::string(nearest_name(button, buttons)) + "\", with alt+, ctrl+ or shift+ before it");
      const auto* deed = value.as_string();
      const auto does = deed == nullptr ? deeds.end() : std::find(deeds.begin(), deeds.end(), deed->get());
      if (does == deeds.end())
        return wrong(value, "\"" + std::string(key.str()) + "\" can't do that; " +
                                (deed == nullptr ? std::string("name in quotes what it does")
                                                 : "the nearest is \"" + std::string(nearest_name(deed->get(), deeds)) + "\""));
      binding.button = static_cast<MouseButton>(which - buttons.begin());
      binding.does = static_cast<Does>(does - deeds.begin());
      out.push_back(binding);
    }
    // Tables come in the alphabet's order: plain buttons first, so that the words about them read well.
    std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
      const auto rank = [](const auto& one) {
        return std::pair(static_cast<int>(one.does), one.modifiers.alt + 2 * one.modifiers.ctrl + 4 * one.modifiers.shift);
      };
      return rank(a) < rank(b);
    });
    return {};
  }

  Result<MouseLayout> complete(MouseLayout layout) const {
    for (const DragDoes needed : {DragDoes::outline, DragDoes::orbit, DragDoes::pan})
      if (std::none_of(layout.drags_.begin(), layout.drags_.end(), [&](const auto& binding) { return binding.does == needed; }))
        return fail(file_, 0,
                    "no drag does \"" + std::string(kDrags[static_cast<std::size_t>(needed)]) + "\": without it the hand is lost");
    if (std::none_of(layout.clicks_.begin(), layout.clicks_.end(), [](const auto& binding) { return binding.does == ClickDoes::pick; }))
      return fail(file_, 0, "no click does \"pick\": without it no node can be selected");
    if (std::none_of(layout.wheels_.begin(), layout.wheels_.end(), [](const auto& binding) { return binding.does == WheelDoes::zoom; }) &&
        std::none_of(layout.drags_.begin(), layout.drags_.end(), [](const auto& binding) { return binding.does == DragDoes::zoom; }))
      return fail(file_, 0, "neither the wheel nor a drag does \"zoom\"");
    return layout;
  }

  std::string file_;
};

Result<MouseLayout> MouseLayout::parse(std::string_view text, const std::string& file) {
  try {
    return MouseReader(file).read(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    return fail(file, static_cast<long>(error.source().begin.line), std::string(error.description()));
  }
}

template <class Does>
const MouseLayout::Binding<Does>* MouseLayout::find(const std::vector<Binding<Does>>& all, MouseButton button, const Modifiers& modifiers) {
  const auto exactly = [&](const Modifiers& wanted) -> const Binding<Does>* {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.button == button && one.modifiers == wanted; });
    return found == all.end() ? nullptr : &*found;
  };
  if (const auto* found = exactly(modifiers)) return found;
  return exactly({false, false, modifiers.alt});
}

DragDoes MouseLayout::drag(MouseButton button, const Modifiers& modifiers) const {
  if (const auto* found = find(drags_, button, modifiers)) return found->does;
  const auto* plain = find(drags_, button, {});
  return plain != nullptr ? plain->does : DragDoes::orbit;
}

ClickDoes MouseLayout::click(MouseButton button, const Modifiers& modifiers) const {
  const auto* found = find(clicks_, button, modifiers);
  return found != nullptr ? found->does : ClickDoes::nothing;
}

ClickDoes MouseLayout::double_click(MouseButton button, const Modifiers& modifiers) const {
  const auto* found = find(double_clicks_, button, modifiers);
  return found != nullptr ? found->does : ClickDoes::nothing;
}

WheelDoes MouseLayout::wheel(const Modifiers& modifiers) const {
  const auto* found = find(wheels_, MouseButton::left, modifiers);
  return found != nullptr ? found->does : WheelDoes::zoom;
}

bool MouseLayout::takes_modifiers(MouseButton button, const Modifiers& modifiers) const {
  const auto* found = find(drags_, button, modifiers);
  return found != nullptr && (found->modifiers.ctrl || found->modifiers.shift);
}

std::vector<MouseBinding> MouseLayout::in_words() const {
  std::vector<MouseBinding> words;
  const auto add = [&](const auto& bindings, std::string_view how, std::span<const std::string_view> meanings) {
    for (const auto& binding : bindings) {
      const std::string button(how == "wheel" ? "wheel" : kButtons[static_cast<std::size_t>(binding.button)]);
      words.push_back({input::in_words(binding.modifiers) + button + (how == "wheel" ? "" : " " + std::string(how)),
                       std::string(meanings[static_cast<std::size_t>(binding.does)])});
    }
  };
  add(clicks_, "click", kClickMeanings);
  add(double_clicks_, "double click", kClickMeanings);
  add(drags_, "drag", kDragMeanings);
  add(wheels_, "wheel", kWheelMeanings);
  words.push_back({"with Shift, Ctrl, both", "what is selected is added, taken away, kept where it was selected before"});
  words.push_back({"left drag on the arrow", "lift the selection along the normal; Esc cancels"});
  words.push_back({"left drag on the disk", "slide the selection on the surface; Esc cancels"});
  words.push_back({"left drag on the ring", "move the selection in the plane of the screen; Esc cancels"});
  words.push_back({"left drag on the ball or its circle", "turn the selection about the picked axis; Esc cancels"});
  words.push_back({"digits over arrow, disk or ball, or while pulling", "type by how much; Enter does it"});
  return words;
}

Result<MouseLayout> find_mouse_layout(const std::string& name_or_file) {
  for (const MouseText& text : kMouseTexts)
    if (text.name == name_or_file) return MouseLayout::parse(text.text, "kiosk/tools/mouse/" + name_or_file + ".toml");
  if (name_or_file.find('/') != std::string::npos || name_or_file.ends_with(".toml")) {
    const Result<FileBytes> bytes = read_file(name_or_file);
    if (!bytes) return fail(bytes.error());
    return MouseLayout::parse(bytes->text(), name_or_file);
  }
  std::vector<std::string_view> names;
  for (const MouseText& text : kMouseTexts) names.push_back(text.name);
  return fail(name_or_file, "there is no mouse layout of this name; the nearest is \"" + std::string(nearest_name(name_or_file, names)) +
                                "\", and a file of your own needs a slash or .toml in its name");
}

MouseLayout default_mouse_layout() {
  Result<MouseLayout> layout = find_mouse_layout("default");
  if (!layout) throw std::logic_error(layout.error().text());  // compiled in and tested
  return std::move(*layout);
}

}  // namespace prismesh::kiosk::input
