// The JSON definition of a type: its fields are named once, for reading (base/json/read.h) and writing (base/json/write.h) alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace prismesh::json {

/// By specialisation, one of:
/// - an object: `static void fields(auto& m, auto& f)` calls f(name, member, limits...) for each field, f.required(...) for one that must
///   not be missing. Optional: `kExample`, an object as a person writes it, for errors; `is_absent(m)`, whether a field that holds the
///   object isn't written
/// - an enumeration: `static const Names<T>& names()`
/// - anything else: `static void write(Json&, const T&)` and `static Problem read(const Json&, T&, Author, limits...)`
template <class T>
struct Definition;

/// The values of an enumeration and their names.
template <class E>
using Names = std::vector<std::pair<std::string_view, E>>;

#define PRISMESH_JSON_OBJECT(Type, ...)                                                     \
  template <>                                                                               \
  struct Definition<Type> {                                                                 \
    static void fields([[maybe_unused]] auto& m, [[maybe_unused]] auto& f) { __VA_ARGS__; } \
  }

#define PRISMESH_JSON_NAMES(Type, ...)               \
  template <>                                        \
  struct Definition<Type> {                          \
    static const Names<Type>& names() {              \
      static const Names<Type> kNames = __VA_ARGS__; \
      return kNames;                                 \
    }                                                \
  }

// --- limits of a field's value ---

inline constexpr double kMaxNumber = 1e300;  ///< what people may write: finite, with room for arithmetic

struct NumberLimits {
  double min = -kMaxNumber;
  double max = kMaxNumber;
  bool above_min = false;  ///< `min` itself is refused
};

struct WholeNumberLimits {
  std::int64_t min = 0;
  std::int64_t max = 0;
};

struct ListLimits {
  std::size_t min_count = 0;
  std::size_t max_count = 0;
  std::string_view items;  ///< plural, for errors: "points [x, y]"
  std::string_view item;   ///< singular; empty: an error of an item is told as one of the list
};

/// A bool that is written as one of two words.
struct TwoWords {
  std::string_view if_false;
  std::string_view if_true;
  std::string_view choice;  ///< both, explained, for errors
};

}  // namespace prismesh::json
