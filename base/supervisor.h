// Tells systemd how the program is: ready, alive, ending. Without systemd these do nothing.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace prismesh::supervisor {

/// The program does what it is for. `status`: a line for people who ask systemd.
void tell_ready(const std::string& status);
void tell_ending();
/// Waits for two seconds under systemd, so that a program that can't start isn't started again many times a second. A signal ends it.
void wait_before_failing();
/// The program works: call it at least every `period`.
void tell_alive();

/// Changes the time after which systemd takes the program for hung, for work that takes longer.
void set_max_silence(std::chrono::microseconds time);

/// Half the time after which systemd takes the program for hung; nothing: it doesn't watch it.
std::optional<std::chrono::microseconds> period();

}  // namespace prismesh::supervisor
