// Writes the JSON of --json, some of it from the objects of mesh/report; scripts rely on its fields. Only json_output.cpp and
// remote_json.cpp include the JSON library. Inner to cli.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/bench_figures.h"
#include "cli/device_figures.h"
#include "cli/figures.h"
#include "cli/machine_checks.h"
#include "mesh/batch/table.h"
#include "mesh/connections/flange.h"
#include "mesh/document/contacts.h"
#include "mesh/document/document.h"
#include "mesh/document/edit_report.h"
#include "mesh/document/journal.h"
#include "mesh/document/weld_checks.h"
#include "mesh/measure/cross_section.h"
#include "mesh/measure/lengths.h"
#include "mesh/report/check_figures.h"
#include "mesh/report/comparison.h"

namespace prismesh::cli {

// Each returns one line without a line break.
std::string info_json(const mesh::document::Document& document);
std::string check_json(const mesh::document::Document& document, const mesh::report::CheckFigures& figures);
std::string diff_json(const mesh::report::Difference& difference);
/// Of `report`. `missing`: why a picture is missing; empty: none is.
std::string report_json(const std::string& file, std::size_t bytes, const std::string& missing);
/// Of `batch`: how the study stands.
std::string batch_json(const mesh::batch::Table& table, const std::string& page);
std::string submitted_json(std::size_t variants, const std::string& job, const std::string& collector);
std::string edit_json(const mesh::document::EditReport& report);
std::string failed_edit_json(const std::string& edit, const std::string& reason);
std::string replay_json(const std::vector<mesh::document::ReplayStep>& steps, const std::string& deck_hash, bool other_deck);
std::string distance_json(const Gap& gap);
std::string welds_json(const mesh::document::WeldChecks& checks);
/// `nodes`: those that were measured.
std::string measure_json(const mesh::Model& model, std::span<const mesh::NodeIndex> nodes, const mesh::measure::NodeMeasures& measures);
std::string cross_section_json(const mesh::Model& model, const mesh::measure::CrossSection& section);
std::string flanges_json(const mesh::Model& model, const mesh::connections::Flanges& flanges);
std::string penetrations_json(const mesh::document::Contacts& contacts);
std::string bench_json(const BenchReport& report);
/// Of `doctor`.
std::string findings_json(const std::vector<Finding>& findings);
std::string devices_json(const DeviceFigures& figures);

}  // namespace prismesh::cli
