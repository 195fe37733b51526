// Makes the sample deck: a sheet-metal assembly of any size, the same bytes for the same size on every machine.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/progress.h"

namespace prismesh::mesh::deck {

inline constexpr std::size_t kSampleShellsMin = 2'000;
inline constexpr std::size_t kSampleShellsDefault = 5'000;
inline constexpr std::size_t kSampleShellsMax = 5'000'000;

/// The LS-DYNA text of the assembly (rail with closing plate, pillar, floor, crossmember, spot welds; mm, t, s) with about
/// `shells` shell elements (within 1 %). Depends on nothing but `shells`. Precondition: within the limits above.
std::string sample_text(std::size_t shells);

/// Writes sample_text to a file, whole or not at all. Errors: `shells` outside the limits (they are named), the file can't be
/// written, cancelled.
Result<void> write_sample(const std::filesystem::path& path, std::size_t shells, const Progress& progress = {});

}  // namespace prismesh::mesh::deck
