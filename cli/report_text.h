// Formats and prints what commands tell people. Inner to cli.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "cli/context.h"
#include "mesh/document/document.h"
#include "mesh/document/edit_report.h"
#include "mesh/report/printable.h"

namespace prismesh::cli {

using mesh::report::as_written;
using mesh::report::printable;

/// A number with the fewest digits that read back as the same double.
std::string shortest(double value);

/// The target size, or the range of those of the parts with shells: "5", "0.5 to 130".
std::string target_sizes(const mesh::document::Document& document);
/// The names of the criteria, those of the document first: "default", or "default, strict by part".
std::string criteria_names(const mesh::document::Document& document);

/// A number with at most six digits: for measured lengths.
std::string rounded(double value);

/// "2026-11-28 17:30", of seconds since 1970, in UTC.
std::string day_and_time(std::int64_t seconds);

/// What an edit made: "3 nodes moved", "2 elements added, 1 element removed", "6 welds added".
std::string change_words(const mesh::document::EditReport& report);

/// Prints what an edit did in a line, and its notes.
void print_edit(std::ostream& out, const mesh::document::EditReport& report);

/// Prints a reason on standard error, as `file:line: message`.
void say(const Context& context, const Error& error);
/// Prints the deck's warnings and guessed settings on standard error, for commands whose output doesn't contain them.
void say_warnings(const Context& context, const mesh::document::Document& document);
void say_warnings(const Context& context, std::span<const mesh::deck::Warning> warnings);
void say_guesses(const Context& context, const mesh::document::Document& document);
/// The same of the length unit alone, for commands that only measure.
void say_unit_guess(const Context& context, const mesh::document::Document& document);

/// Flushes standard output and returns whether everything was written; prints a reason if not. Call it before writing a deck, since a
/// command that fails writes nothing.
bool output_is_good(const Context& context);

}  // namespace prismesh::cli
