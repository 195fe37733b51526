#include "python/long_work.h"

#include <string>

#include "mesh/report/printable.h"

namespace prismesh::python {

namespace py = pybind11;

constexpr std::chrono::milliseconds kBetweenQuestions{50};

LongWork::LongWork(py::object listener) : listener_(std::move(listener)) {
  if (!listener_.is_none() && PyCallable_Check(listener_.ptr()) == 0)
    throw py::type_error("progress must be a function of the fraction done and of words, or None");
}

bool LongWork::is_to_go_on(double fraction, const Doing& doing) {
  if (stopped_) return false;
  const auto now = std::chrono::steady_clock::now();
  if (asked_ && now - *asked_ < kBetweenQuestions) return true;
  asked_ = now;
  const py::gil_scoped_acquire held;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (listener_.is_none()) return true;
    const py::object answer = listener_(fraction, mesh::report::printable(doing ? doing() : std::string()));
    stopped_ = answer.is(py::bool_(false));
  } catch (const py::error_already_set&) {
    raised_ = std::current_exception();
    stopped_ = true;
  }
  return !stopped_;
}

void LongWork::raise_what_stopped_it() {
  if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
}

}  // namespace prismesh::python
