// Long work without the GIL, which Ctrl-C and a function of the user's can stop. Inner to python.
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <utility>

#include <pybind11/pybind11.h>

#include "base/progress.h"
#include "python/errors.h"

namespace prismesh::python {

/// Runs work without the GIL. At most twenty times a second the work's progress takes the GIL, to let Python handle signals and to call the
/// user's function with the fraction done and the words of what is being done; when that returns False, the work is told to stop. What a
/// handler of signals or the function raises stops it too.
class LongWork {
 public:
  /// `listener`: a function, or None. Raises TypeError for others.
  explicit LongWork(pybind11::object listener);

  /// Returns the result, also one that the work has kept after it was told to stop: then `raise_what_stopped_it` is the caller's to call.
  template <class Work>
  auto run(const Work& work) {
    const Progress progress([this](double fraction, const Doing& doing) { return is_to_go_on(fraction, doing); });
    const pybind11::gil_scoped_release released;
    return work(progress);
  }
  /// Raises what a handler of signals or the user's function has raised, if it has.
  void raise_what_stopped_it();

 private:
  bool is_to_go_on(double fraction, const Doing& doing);

  pybind11::object listener_;
  std::optional<std::chrono::steady_clock::time_point> asked_;
  std::exception_ptr raised_;
  bool stopped_ = false;
};

}  // namespace prismesh::python
