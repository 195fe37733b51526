// Resolves coordinate systems: CORD1R/C/S by three grid points, CORD2R/C/S by three points in another system.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "mesh/deck/data/frame.h"
#include "mesh/deck/nastran/card.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::deck::nastran {

struct SystemCard {
  std::int64_t id = 0;
  Frame::Kind kind = Frame::Kind::rectangular;
  bool by_grids = false;
  std::int64_t reference = 0;           ///< system of the points; 0: basic
  std::array<std::int64_t, 3> grids{};  ///< origin, on the z axis, in the xz plane
  std::array<Vec3, 3> points{};         ///< CORD2: the same, as points
  std::uint32_t file = 0;
  std::size_t offset = 0;
};

/// Adds the systems of a CORD card. False: the card is none. `bad`: set if a number on it can't be read.
bool read_systems(const Card& card, std::size_t offset, std::vector<SystemCard>& systems, bool& bad);

/// Where a grid point's card puts it, and in which system.
struct GridPlace {
  Vec3 position = Vec3::Zero();
  std::int64_t system = 0;
};

/// All systems of a deck, resolved from each other. Of equal ids the first counts.
class Systems {
 public:
  /// `grid` gives the place of a grid point that spans a system; nullopt: there is none.
  Systems(std::vector<SystemCard> cards, const std::function<std::optional<GridPlace>(std::int64_t)>& grid);

  /// nullopt: it isn't defined, depends on itself, or its points lie on one line.
  std::optional<Frame> find(std::int64_t id) const;
  bool defined(std::int64_t id) const;

  struct Bad {
    const SystemCard* card;
    const char* why;  ///< the end of a sentence about the system
  };
  const std::vector<Bad>& bad() const { return bad_; }
  const std::vector<SystemCard>& duplicates() const { return duplicates_; }

 private:
  enum class Resolution : std::uint8_t { waiting, open, done, bad };
  struct Entry {
    SystemCard card;
    Resolution resolution = Resolution::waiting;
    Frame frame;
  };
  Entry* entry(std::int64_t id);
  const Entry* entry(std::int64_t id) const { return const_cast<Systems*>(this)->entry(id); }
  void work_out(Entry& first);
  bool ready(std::int64_t system, std::vector<Entry*>& waiting, const char*& why);
  void settle(Entry& entry, std::vector<Entry*>& waiting);
  std::optional<Vec3> basic(const Vec3& place, std::int64_t system) const;

  std::vector<Entry> entries_;  ///< ascending by id
  const std::function<std::optional<GridPlace>(std::int64_t)>& grid_;
  std::vector<Bad> bad_;
  std::vector<SystemCard> duplicates_;
};

}  // namespace prismesh::mesh::deck::nastran
