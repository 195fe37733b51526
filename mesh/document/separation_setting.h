// The model in which shells are separated, with what its document says about the nodes. Private to mesh/document.
#pragma once

#include <vector>

#include "mesh/contact/separation.h"
#include "mesh/document/document.h"
#include "mesh/document/kept_welds.h"
#include "mesh/document/pins.h"

namespace prismesh::mesh::document {

class SeparationSetting {
 public:
  /// The document must outlive it. Costs the model's tree of boxes, and what joins its sheets.
  SeparationSetting(const Document& document, contact::ContactThickness thickness);
  SeparationSetting(const SeparationSetting&) = delete;
  SeparationSetting& operator=(const SeparationSetting&) = delete;

  /// Points into this object.
  contact::SeparationInput input() const;

 private:
  const Generation& generation_;
  quality::SizedCriteria criteria_;
  contact::ContactThickness thickness_;
  spatial::BoxTree tree_;
  KeptWelds welds_;
  Pins pins_;
  std::vector<connections::JoinedSheets::Pair> joints_;
};

}  // namespace prismesh::mesh::document
