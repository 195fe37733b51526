// Which mutant is switched on. Every file of the copy that `./station mutate` breaks includes it; the project itself doesn't.
#pragma once

namespace prismesh::mutant {

extern int chosen;  // 0: none; negative: all that are asked for are recorded
void record(int number);

/// Whether the program runs with this mutant.
inline bool on(int number) {
  const int now = chosen;
  if (now == number) [[unlikely]]
    return true;
  if (now < 0) [[unlikely]]
    record(number);
  return false;
}

/// The same in constexpr functions: never while compiling.
constexpr bool on_at_run_time(int number) { return !__builtin_is_constant_evaluated() && on(number); }

}  // namespace prismesh::mutant
