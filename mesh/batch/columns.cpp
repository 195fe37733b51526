#include "mesh/batch/columns.h"

namespace prismesh::mesh::batch {

namespace {

template <class T>
std::optional<double> known(const std::optional<T>& value) {
  return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
}
template <class T>
std::optional<double> known(T value) {
  return static_cast<double>(value);
}

using Of = const VariantResult&;

constexpr Column kColumns[] = {
    {"fail", "fail", true, false, [](Of r) { return known(r.after.fail); }, [](Of r) { return known(r.before.fail); }},
    {"warn", "warn", true, false, [](Of r) { return known(r.after.warn); }, [](Of r) { return known(r.before.warn); }},
    {"perforations", "perforations", true, false, [](Of r) { return known(r.after.perforations); },
     [](Of r) { return known(r.before.perforations); }},
    {"penetrations", "penetrations", true, false, [](Of r) { return known(r.after.penetrations); },
     [](Of r) { return known(r.before.penetrations); }},
    {"depth", "deepest", true, true, [](Of r) { return known(r.after.depth); }, [](Of r) { return known(r.before.depth); }},
    {"mass", "mass", true, false, [](Of r) { return known(r.after.mass); }, [](Of r) { return known(r.before.mass); }},
    {"time_step", "time step", true, false, [](Of r) { return known(r.after.time_step); }, [](Of r) { return known(r.before.time_step); }},
    {"composite_mean", "composite", true, false, [](Of r) { return known(r.after.composite_mean); },
     [](Of r) { return known(r.before.composite_mean); }},
    {"triangles_percent", "triangles, %", false, false, [](Of r) { return known(r.after.triangles_percent); },
     [](Of r) { return known(r.before.triangles_percent); }},
    {"max_displacement", "displacement", true, true, [](Of r) { return known(r.max_displacement); }},
    {"nodes_moved", "nodes moved", false, false, [](Of r) { return known(r.nodes_moved); }},
    {"elements_added", "added", false, false, [](Of r) { return known(r.elements_added); }},
    {"elements_removed", "removed", false, false, [](Of r) { return known(r.elements_removed); }},
    {"lines_changed", "lines", false, false, [](Of r) { return known(r.lines_changed); }},
    {"seconds", "seconds", false, false, [](Of r) { return known(r.seconds); }},
    {"peak_mb", "MB", false, false, [](Of r) { return known(r.peak_mb); }},
};

}  // namespace

std::span<const Column> columns() { return kColumns; }

std::optional<double> figure_of(const Column& column, const Row& row) {
  if (row.state != RowState::done) return std::nullopt;
  return column.of(*row.result);
}

std::optional<double> figure_before(const Column& column, const Row& row) {
  if (row.state != RowState::done || column.before == nullptr) return std::nullopt;
  return column.before(*row.result);
}

std::string written_file(const Row& row) {
  return row.state == RowState::done ? "variants/" + row.key + "/" + row.result->written : std::string();
}

}  // namespace prismesh::mesh::batch
