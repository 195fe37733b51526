#include "kiosk/display/kms/keyboard.h"

#include <array>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>
#include <xkbcommon/xkbcommon-compose.h>
#include <xkbcommon/xkbcommon.h>

#include "kiosk/display/key_symbols.h"

namespace prismesh::kiosk::display::kms {
namespace {

constexpr std::uint32_t kEvdevOffset = 8;  ///< X11's codes begin at 8

struct Unref {
  void operator()(xkb_context* made) const { xkb_context_unref(made); }
  void operator()(xkb_keymap* made) const { xkb_keymap_unref(made); }
  void operator()(xkb_state* made) const { xkb_state_unref(made); }
  void operator()(xkb_compose_table* made) const { xkb_compose_table_unref(made); }
  void operator()(xkb_compose_state* made) const { xkb_compose_state_unref(made); }
};
template <class T>
using Xkb = std::unique_ptr<T, Unref>;

int console_of(xkb_keysym_t symbol) {
  const bool is_one = symbol >= XKB_KEY_XF86Switch_VT_1 && symbol <= XKB_KEY_XF86Switch_VT_12;
  return is_one ? static_cast<int>(symbol - XKB_KEY_XF86Switch_VT_1) + 1 : 0;
}

bool is_printable(const std::string& text) {
  return !text.empty() && static_cast<unsigned char>(text.front()) >= 0x20 && text.front() != 0x7f;
}

}  // namespace

struct Keyboard::Impl {
  Xkb<xkb_context> context;
  Xkb<xkb_keymap> keymap;
  Xkb<xkb_state> state;
  Xkb<xkb_compose_table> table;
  Xkb<xkb_compose_state> compose;  ///< null: the locale has no dead keys

  bool held(const char* modifier) const { return xkb_state_mod_name_is_active(state.get(), modifier, XKB_STATE_MODS_EFFECTIVE) > 0; }

  /// The key's symbol without modifiers, in the layout that is chosen.
  xkb_keysym_t plain(std::uint32_t code) const {
    const xkb_keysym_t* symbols = nullptr;
    const xkb_layout_index_t layout = xkb_state_key_get_layout(state.get(), code);
    return xkb_keymap_key_get_syms_by_level(keymap.get(), code, layout, 0, &symbols) == 1 ? symbols[0] : xkb_keysym_t{XKB_KEY_NoSymbol};
  }

  std::string text(std::uint32_t code, xkb_keysym_t symbol) {
    std::array<char, 64> bytes{};
    if (compose && xkb_compose_state_feed(compose.get(), symbol) == XKB_COMPOSE_FEED_ACCEPTED) {
      const xkb_compose_status status = xkb_compose_state_get_status(compose.get());
      if (status == XKB_COMPOSE_COMPOSING) return {};
      if (status == XKB_COMPOSE_COMPOSED) xkb_compose_state_get_utf8(compose.get(), bytes.data(), bytes.size());
      if (status == XKB_COMPOSE_COMPOSED || status == XKB_COMPOSE_CANCELLED) {
        xkb_compose_state_reset(compose.get());
        return bytes.data();
      }
    }
    xkb_state_key_get_utf8(state.get(), code, bytes.data(), bytes.size());
    return bytes.data();
  }
};

Keyboard::Keyboard(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Keyboard::Keyboard(Keyboard&&) noexcept = default;
Keyboard& Keyboard::operator=(Keyboard&&) noexcept = default;
Keyboard::~Keyboard() = default;

Result<Keyboard> Keyboard::create(const KeyboardNames& names) {
  auto impl = std::make_unique<Impl>();
  impl->context.reset(xkb_context_new(XKB_CONTEXT_NO_FLAGS));
  if (!impl->context) return fail("the keyboard", "the keyboard layouts can't be read: on Debian install xkb-data");
  xkb_context_set_log_level(impl->context.get(), XKB_LOG_LEVEL_CRITICAL);
  const auto or_default = [](const std::string& name) { return name.empty() ? nullptr : name.c_str(); };
  xkb_rule_names wanted{};
  wanted.model = or_default(names.model);
  wanted.layout = or_default(names.layout);
  wanted.variant = or_default(names.variant);
  wanted.options = or_default(names.options);
  impl->keymap.reset(xkb_keymap_new_from_names(impl->context.get(), &wanted, XKB_KEYMAP_COMPILE_NO_FLAGS));
  if (!impl->keymap)
    return fail("/etc/default/keyboard",
                fmt::format("there is no keyboard layout \"{}\" with the variant \"{}\"", names.layout, names.variant));
  impl->state.reset(xkb_state_new(impl->keymap.get()));
  const char* locale = "C";
  for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"})
    if (const char* value = std::getenv(variable); value != nullptr && *value != '\0') {
      locale = value;
      break;
    }
  impl->table.reset(xkb_compose_table_new_from_locale(impl->context.get(), locale, XKB_COMPOSE_COMPILE_NO_FLAGS));
  if (impl->table) impl->compose.reset(xkb_compose_state_new(impl->table.get(), XKB_COMPOSE_STATE_NO_FLAGS));
  return Keyboard(std::move(impl));
}

Key Keyboard::key(std::uint32_t code) const {
  const Key plain = key_from_symbol(impl_->plain(code + kEvdevOffset));
  return plain != Key::none ? plain : key_from_symbol(xkb_state_key_get_one_sym(impl_->state.get(), code + kEvdevOffset));
}

KeyMeaning Keyboard::meaning(std::uint32_t code) {
  const std::uint32_t key = code + kEvdevOffset;
  KeyMeaning meaning;
  const xkb_keysym_t symbol = xkb_state_key_get_one_sym(impl_->state.get(), key);
  meaning.key = this->key(code);
  meaning.console = console_of(symbol);
  meaning.repeats = xkb_keymap_key_repeats(impl_->keymap.get(), key) != 0;
  std::string text = impl_->text(key, symbol);
  const Modifiers held = modifiers();
  if (is_printable(text) && !held.ctrl && !held.alt) meaning.text = std::move(text);
  return meaning;
}

void Keyboard::set(std::uint32_t code, bool down) {
  xkb_state_update_key(impl_->state.get(), code + kEvdevOffset, down ? XKB_KEY_DOWN : XKB_KEY_UP);
}

Modifiers Keyboard::modifiers() const {
  return {impl_->held(XKB_MOD_NAME_SHIFT), impl_->held(XKB_MOD_NAME_CTRL), impl_->held(XKB_MOD_NAME_ALT)};
}

void Keyboard::forget() {
  impl_->state.reset(xkb_state_new(impl_->keymap.get()));
  if (impl_->compose) xkb_compose_state_reset(impl_->compose.get());
}

}  // namespace prismesh::kiosk::display::kms
