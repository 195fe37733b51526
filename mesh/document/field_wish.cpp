#include "mesh/document/field_wish.h"

#include <array>
#include <vector>

#include "base/nearest_name.h"

namespace prismesh::mesh::document {

namespace {

struct Named {
  FieldWish::Of of;
  std::string_view name;
};
constexpr std::string_view kMetricPrefix = "metric:";
constexpr std::array kNamed{Named{FieldWish::Of::displacement, "displacement"},
                            Named{FieldWish::Of::surface_distance, "distance-to-original"}, Named{FieldWish::Of::gap, "distance"},
                            Named{FieldWish::Of::composite, "composite"}, Named{FieldWish::Of::time_step, "time-step"}};

}  // namespace

Result<FieldWish> field_wish(std::string_view text) {
  FieldWish wish;
  std::vector<std::string_view> known;
  for (const Named& named : kNamed) {
    known.push_back(named.name);
    wish.of = named.of;
    if (text == named.name) return wish;
  }
  wish.of = FieldWish::Of::metric;
  std::vector<std::string> metrics;
  for (int m = 0; m < quality::kMetricCount; ++m) {
    wish.metric = static_cast<quality::Metric>(m);
    metrics.push_back(std::string(kMetricPrefix) + std::string(quality::name(wish.metric)));
    if (text == metrics.back()) return wish;
  }
  known.insert(known.end(), metrics.begin(), metrics.end());
  return fail("colour",
              "there is no field \"" + std::string(text) + "\"; the nearest is \"" + std::string(nearest_name(text, known)) + "\"");
}

std::string name(const FieldWish& wish) {
  for (const Named& named : kNamed)
    if (named.of == wish.of) return std::string(named.name);
  return std::string(kMetricPrefix) + std::string(quality::name(wish.metric));
}

}  // namespace prismesh::mesh::document
