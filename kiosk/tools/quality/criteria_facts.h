// What the quality panel shows of criteria: the deck's, those of single parts, and those that can be chosen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "ipc/model/snapshot_info.h"

namespace prismesh::kiosk::tools::quality {

struct CriteriaFacts {
  std::string of_deck;                                   ///< a built-in name or a file
  std::vector<std::pair<std::string, std::string>> own;  ///< criteria, and the parts that have them, as an expression; ascending
  std::vector<std::string> known;                        ///< what can be chosen: built-in names, then files, each once
  bool of_selection = false;                             ///< something is selected: a choice applies to the selection's parts, else to all
};

/// The facts of a snapshot. `files`: criteria files that are known besides those in use.
CriteriaFacts criteria_facts(const ipc::SnapshotInfo& info, const std::vector<std::filesystem::path>& files);

/// Criteria in a few letters: a built-in name, or a file's name without its folder.
std::string short_criteria(const std::string& criteria);

}  // namespace prismesh::kiosk::tools::quality
