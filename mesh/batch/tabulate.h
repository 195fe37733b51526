// Makes the table of a study, and writes it as CSV, as JSON and as a page.
#pragma once

#include <cstddef>
#include <string>

#include "base/error.h"
#include "mesh/batch/store.h"
#include "mesh/batch/study.h"
#include "mesh/batch/table.h"

namespace prismesh::mesh::batch {

/// Reads what there is in the store. Errors: a result that can't be read; those of Variants::key.
Result<Table> tabulate(const Study& study, const Store& store);

std::string table_csv(const Table& table);
std::string table_json(const Table& table);
/// One page without any other file: failures first, sorted by a click, with pictures of the first kPicturesShown rows and how figures
/// depend on parameters.
std::string table_page(const Table& table, const Store& store);
inline constexpr std::size_t kPicturesShown = 150;

}  // namespace prismesh::mesh::batch
