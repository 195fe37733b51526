// Draws a document by the headless kiosk. Inner to cli.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/context.h"
#include "ipc/wire/descriptor.h"
#include "mesh/document/document.h"
#include "mesh/document/field_wish.h"
#include "mesh/report/figures.h"

namespace prismesh::cli {

/// A field for the kiosk: its values in shared memory, and the arguments that describe it.
struct SealedField {
  ipc::Descriptor values;
  std::vector<std::string> arguments;
};

/// `other`: the model that the field compares with, if it does. `compared_with`: the legend's words for it. `limits`: CLEAR,FULL of the
/// colour map; absent: the field's own. Errors: those of make_field; no memory.
Result<SealedField> seal_field(const mesh::document::Document& document, const mesh::document::FieldWish& wish, const mesh::Model* other,
                               const std::string& compared_with, const std::optional<std::string>& limits);

/// Seals a snapshot and starts the kiosk beside this program, with more of its arguments. `field`: a descriptor that it inherits besides;
/// -1: none. Returns the kiosk's exit status, which has said what was wrong. Errors: there is no kiosk, no memory, it was stopped or
/// killed.
Result<int> draw_picture(const mesh::document::Document& document, const std::filesystem::path& output,
                         const std::vector<std::string>& more, int field, const Context& context);

/// The kiosk's argument for a picture that is filled by a box.
std::string box_argument(const mesh::report::PartFigures::Box& box);
/// CLEAR,FULL of seal_field for displacements up to `largest`: what moved by less than a fiftieth of that keeps its part's colour.
std::string displacement_limits(double largest);

}  // namespace prismesh::cli
