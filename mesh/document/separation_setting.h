// The model in which shells are separated, with what its document says about the nodes. Private to mesh/document.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "mesh/contact/separation.h"
#include "mesh/document/document.h"
#include "mesh/document/kept_welds.h"
#include "mesh/document/pins.h"

namespace prismesh::mesh::document {

class SeparationSetting {
 public:
  /// The document must outlive it. Shells whose contact surface lies beside their nodes take part, but stay. Costs the model's tree of
  /// boxes, and what joins its sheets.
  SeparationSetting(const Document& document, contact::ContactThickness thickness);
  SeparationSetting(const SeparationSetting&) = delete;
  SeparationSetting& operator=(const SeparationSetting&) = delete;

  /// Points into this object.
  contact::SeparationInput input() const;

 private:
  std::string_view why_stays(NodeIndex node) const;

  const Generation& generation_;
  quality::SizedCriteria criteria_;
  contact::ContactThickness thickness_;
  Model surface_;                            ///< on which shells meet: the model, but for shells that are offset
  std::vector<std::uint8_t> beside_offset_;  ///< one a node, 1: of a shell with a node that isn't where the surface is; empty: none is
  spatial::BoxTree tree_;
  KeptWelds welds_;
  Pins pins_;
  std::vector<connections::JoinedSheets::Pair> joints_;
};

}  // namespace prismesh::mesh::document
