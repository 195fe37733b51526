// The Verdict library, where this machine has it (package python3-vtk9 brings it): loaded at run time, so that nothing needs it to be
// built.
#pragma once

#include <string>

#include <dlfcn.h>

namespace prismesh::test {

class VerdictLibrary {
 public:
  using Metric = double (*)(int corners, double coordinates[][3]);

  /// What was found, or nothing.
  static const VerdictLibrary& get() {
    static const VerdictLibrary library;
    return library;
  }

  bool is_there() const { return handle_ != nullptr; }
  static const char* how_to_get() { return "the Verdict library isn't here (package python3-vtk9): nothing compared"; }

  /// By its name in Verdict, e.g. "quad_skew"; nullptr if the library has none.
  Metric metric(const std::string& name) const { return reinterpret_cast<Metric>(dlsym(handle_, ("vtkverdict__v_" + name).c_str())); }

 private:
  VerdictLibrary() {
    for (const char* name : {"libvtkverdict-9.1.so.1", "libvtkverdict-9.0.so.1", "libvtkverdict-9.1.so", "libvtkverdict-9.0.so"})
      if (handle_ == nullptr) handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (handle_ != nullptr && metric("quad_skew") == nullptr) handle_ = nullptr;
  }

  void* handle_ = nullptr;
};

}  // namespace prismesh::test
