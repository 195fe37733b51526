// The Verdict library, where this machine has it (package python3-vtk9 brings it): loaded at run time, so that no build
// needs it.
#pragma once

#include <array>
#include <string>

#include <dlfcn.h>

namespace prismesh::test {

class VerdictLibrary {
 public:
  using Metric = double (*)(int corners, double coordinates[][3]);
  using QuadValues = std::array<double, 9>;
  using AllOfQuad = QuadValues (*)(double coordinates[][3]);

  /// What was found, or nothing.
  static const VerdictLibrary& get() {
    static const VerdictLibrary library;
    return library;
  }

  bool is_there() const { return handle_ != nullptr; }
  static const char* how_to_get() { return "the Verdict library isn't here (package python3-vtk9): nothing compared"; }

  /// Nine metrics of a quad by Verdict's one call for several: skew, taper, warpage, area, stretch, smallest and largest angle, scaled
  /// Jacobian and the larger edge ratio. nullptr if the library has no such call.
  AllOfQuad all_of_quad() const {
    if (quality() == nullptr) return nullptr;
    return [](double coordinates[][3]) {
      // The library's record is 23 numbers, in the order of its header; bits of the request in the order of its metrics.
      enum { kSkew = 6, kTaper = 7, kWarpage = 8, kArea = 9, kStretch = 10, kMin = 11, kMax = 12, kScaled = 16, kEdges = 1 };
      constexpr unsigned kRequest = 1 | 2 | 4 | 8 | 16 | 32 | 64 | 128 | 2048;
      double record[32] = {};
      quality()(4, coordinates, kRequest, record);
      return QuadValues{record[kSkew], record[kTaper], record[kWarpage], record[kArea], record[kStretch],
                        record[kMin],  record[kMax],   record[kScaled],  record[kEdges]};
    };
  }

  /// By its name in Verdict, e.g. "quad_skew"; nullptr if the library has none.
  Metric metric(const std::string& name) const { return reinterpret_cast<Metric>(dlsym(handle_, ("vtkverdict__v_" + name).c_str())); }

 private:
  VerdictLibrary() {
    for (const char* name : {"libvtkverdict-9.1.so.1", "libvtkverdict-9.0.so.1", "libvtkverdict-9.1.so", "libvtkverdict-9.0.so"})
      if (handle_ == nullptr) handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (handle_ != nullptr && metric("quad_skew") == nullptr) handle_ = nullptr;
  }

  using Quality = void (*)(int corners, double coordinates[][3], unsigned request, double* record);
  static Quality quality() {
    static const auto found = reinterpret_cast<Quality>(dlsym(get().handle_, "vtkverdict__v_quad_quality"));
    return found;
  }

  void* handle_ = nullptr;
};

}  // namespace prismesh::test
