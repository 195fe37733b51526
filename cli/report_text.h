// What commands say to people. Inner to cli.
#pragma once

#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "cli/context.h"
#include "mesh/document/document.h"
#include "mesh/document/edit_report.h"

namespace prismesh::cli {

/// Bytes that aren't UTF-8, and control characters, as \xNN: what can be shown on a terminal and put into JSON.
std::string printable(std::string_view text);

/// A number in the fewest digits that give it back.
std::string shortest(double value);
/// The same, of at most six digits: a measured length for people to read.
std::string rounded(double value);
/// The double that has a float's shortest digits: 8.07f as 8.07, not 8.06999969482422.
double as_written(float value);

/// What an edit did, in a line, and its notes.
void print_edit(std::ostream& out, const mesh::document::EditReport& report);

/// A reason on standard error, as `file:line: message`.
void say(const Context& context, const Error& error);
/// The deck's warnings and guessed settings on standard error, for commands whose output has no room for them.
void say_warnings(const Context& context, const mesh::document::Document& document);
void say_warnings(const Context& context, std::span<const mesh::deck::Warning> warnings);
void say_guesses(const Context& context, const mesh::document::Document& document);

/// Whether all results so far have reached standard output; asked before a deck is written, since a command that fails writes
/// nothing. Says so if not.
bool output_is_good(const Context& context);

}  // namespace prismesh::cli
