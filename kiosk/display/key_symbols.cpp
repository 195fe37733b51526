#include "kiosk/display/key_symbols.h"

#include <xkbcommon/xkbcommon-keysyms.h>

namespace prismesh::kiosk::display {

Key key_from_symbol(std::uint32_t symbol) {
  if (symbol >= XKB_KEY_a && symbol <= XKB_KEY_z) return static_cast<Key>('A' + (symbol - XKB_KEY_a));
  if (symbol >= XKB_KEY_A && symbol <= XKB_KEY_Z) return static_cast<Key>('A' + (symbol - XKB_KEY_A));
  if (symbol >= XKB_KEY_0 && symbol <= XKB_KEY_9) return static_cast<Key>('0' + (symbol - XKB_KEY_0));
  if (symbol >= XKB_KEY_KP_0 && symbol <= XKB_KEY_KP_9) return static_cast<Key>('0' + (symbol - XKB_KEY_KP_0));
  if (symbol >= XKB_KEY_F1 && symbol <= XKB_KEY_F12)
    return static_cast<Key>(static_cast<int>(Key::f1) + static_cast<int>(symbol - XKB_KEY_F1));
  switch (symbol) {
    case XKB_KEY_space: return Key::space;
    case XKB_KEY_Escape: return Key::escape;
    case XKB_KEY_Return:
    case XKB_KEY_KP_Enter: return Key::enter;
    case XKB_KEY_Tab:
    case XKB_KEY_ISO_Left_Tab: return Key::tab;
    case XKB_KEY_BackSpace: return Key::backspace;
    case XKB_KEY_Delete: return Key::remove;
    case XKB_KEY_Insert: return Key::insert;
    case XKB_KEY_Left: return Key::left;
    case XKB_KEY_Right: return Key::right;
    case XKB_KEY_Up: return Key::up;
    case XKB_KEY_Down: return Key::down;
    case XKB_KEY_Home: return Key::home;
    case XKB_KEY_End: return Key::end;
    case XKB_KEY_Page_Up: return Key::page_up;
    case XKB_KEY_Page_Down: return Key::page_down;
    default: return Key::none;
  }
}

}  // namespace prismesh::kiosk::display
