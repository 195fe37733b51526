// The report of an edit: what it changed, as figures and sentences.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/quality/report.h"

namespace prismesh::mesh::document {

/// A repair that ended before it was finished: a cancel kept what it had reached, or the edit says where to stop.
struct StoppedRepair {
  int attempt = 1;                   ///< to find changes that can be written
  std::vector<std::uint64_t> steps;  ///< of this attempt: repair::StoppedAt
  int round = 0;                     ///< of this attempt, from 1; 0: before the first
  int max_rounds = 0;
  std::size_t bad_before = 0;  ///< elements of the scope that failed or warned
  std::size_t bad_left = 0;
};

/// A region that `separate` left as it was.
struct RegionLeft {
  std::string a, b;  ///< "part:1"; empty: of no part
  std::string why;
};
/// What `separate` did.
struct Separated {
  std::size_t regions_before = 0;
  std::size_t regions_removed = 0;
  std::vector<RegionLeft> regions_left;
  double depth_before = 0;  ///< the greatest; deck's length unit
  double depth_after = 0;
  double largest_move = 0;
};

/// A place at which `weld` made no weld, or `bond` no hexahedron.
struct SpotLeft {
  std::array<double, 3> at{};
  std::string why;
};
/// What `weld` did.
struct Welded {
  std::size_t welds_added = 0;  ///< spots; of three sheets one has two elements
  std::size_t spots_left = 0;
  std::vector<SpotLeft> left_out;  ///< the first thousand of them
};

/// What `bond` did.
struct Bonded {
  std::size_t solids_added = 0;
  std::size_t solids_left = 0;
  std::vector<SpotLeft> left_out;  ///< the first thousand of them
  double thinnest = 0;             ///< the least distance of opposite corners, and the greatest; deck's length unit
  double thickest = 0;
};

/// A weld that `repair_welds` left as it is.
struct WeldLeft {
  std::array<double, 3> at{};
  std::string why;  ///< "beam:9: only a sheet of part:3 is there"
};
/// What `repair_welds` did.
struct WeldsMended {
  std::size_t broken = 0;  ///< of those asked for: with a loose end, or joining nothing
  std::size_t mended = 0;
  std::vector<WeldLeft> left;  ///< the first thousand of the others
};

struct EditReport {
  std::string edit;
  std::size_t nodes_moved = 0;
  std::optional<double> largest_move;  ///< of these nodes, between the states before and after; deck's length unit
  std::size_t elements_added = 0;
  std::size_t elements_removed = 0;
  quality::Counts before;
  quality::Counts after;
  std::size_t clusters_before = 0;  ///< nodes with too many triangles about them (docs/quality/structure.md)
  std::size_t clusters_after = 0;
  std::size_t triangle_pairs = 0;  ///< of `repair`: edges between two triangles that it made and that stay (docs/repairing.md)
  std::optional<StoppedRepair> stopped;
  std::optional<Separated> separated;       ///< of `separate`
  std::optional<Welded> welded;             ///< of `weld`
  std::optional<Bonded> bonded;             ///< of `bond`
  std::optional<WeldsMended> welds_mended;  ///< of `repair_welds`
  // of edits that move nodes:
  std::size_t inverted = 0;           ///< shells that it turned over or folded (docs/shaping.md)
  std::size_t lost_connections = 0;   ///< nodes that lay on a sheet and no longer do (docs/connections.md)
  std::vector<std::string> lost;      ///< the first hundred of them, a sentence each
  std::optional<double> mass_before;  ///< of the shells whose mass is known; absent if none is
  std::optional<double> mass_after;
  std::optional<std::array<double, 3>> centre_before;  ///< of gravity
  std::optional<std::array<double, 3>> centre_after;
  std::vector<std::string> notes;
  double milliseconds = 0;  ///< time taken; 0 without a clock
};

}  // namespace prismesh::mesh::document
