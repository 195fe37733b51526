// Text for pages of HTML.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace prismesh::mesh::report {

/// The text for between tags and for attributes in double quotes: printable (mesh/report/printable.h), with &, <, >, " and ' as
/// references.
std::string html_text(std::string_view text);

/// The address of a picture that stands in the page itself. `png`: the file's bytes.
std::string png_address(std::string_view png);

/// The start of a page up to <body>: the title, a policy that lets nothing be loaded from elsewhere, and the style that all our pages
/// share. `scripts`: the policy allows the page's own scripts.
std::string html_head(std::string_view title, bool scripts);

}  // namespace prismesh::mesh::report
