// The messages between the pen's process and its clients, as plain structs (their JSON: messages_json.cpp), in the same form as deviced's.
// docs/protocol.md describes them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "ipc/wire/answers.h"

namespace prismesh::ipc {

inline constexpr int kPenProtocolVersion = 1;

// --- requests ---
struct PenHello {
  int protocol = kPenProtocolVersion;
  std::string program;
};
struct GetPen {};
struct ArmPen {};     ///< forces may come: the pen must be ready and touch nothing
struct DisarmPen {};  ///< zero force
struct SetFeel {      ///< until the process ends; a missing value stays
  std::optional<double> stiffness_newton_m{};
  std::optional<double> friction{};
  std::optional<double> damping_newton_s_m{};
};
struct AttachField {};  ///< descriptor: a page as in haptic_field_page.h. It takes the place of the one before

using PenRequest = std::variant<PenHello, GetPen, ArmPen, DisarmPen, SetFeel, AttachField>;

// --- answers (Failed and Done: ipc/wire/answers.h) ---
struct PenWelcome {  ///< descriptor: the state page
  int protocol = kPenProtocolVersion;
  std::string version;
};
/// The pen's state, for people.
struct PenInfo {
  std::string kind;   ///< "simulated"; empty: no pen is configured
  std::string where;  ///< its port
  bool simulated = false;
  std::string state;    ///< PenStage in words
  std::string trouble;  ///< what is wrong, and what to do about it; empty if nothing is
  double max_newton = 0;
  double stiffness_newton_m = 0;  ///< as set
  double friction = 0;
  double damping_newton_s_m = 0;
  double workspace_scale = 1;  ///< millimetres of the pen for one of the model's length unit
  bool left_handed = false;
  bool operator==(const PenInfo&) const = default;
};
struct Pen {
  PenInfo pen;
};
using PenAnswer = std::variant<Failed, Done, PenWelcome, Pen>;

// --- events ---
struct PenChanged {
  PenInfo pen;
};
using PenEvent = std::variant<PenChanged>;

}  // namespace prismesh::ipc
