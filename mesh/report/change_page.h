// A report on two states of a deck as a page of HTML that needs no other file and no network.
#pragma once

#include <span>
#include <string>

#include "mesh/report/change_report.h"

namespace prismesh::mesh::report {

/// A picture and what it shows.
struct PagePicture {
  std::string png;  ///< the file's bytes; empty: it couldn't be drawn, and `caption` says why
  std::string caption;
};

/// The pictures of a report.
struct ChangePictures {
  PagePicture before, after;
  std::vector<PagePicture> differences;
};

/// The page. Everything that comes from decks and journals is escaped; the same report and pictures give the same bytes.
std::string change_page(const ChangeReport& report, const ChangePictures& pictures);

}  // namespace prismesh::mesh::report
