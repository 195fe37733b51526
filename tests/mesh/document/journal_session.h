// Journals of a small session, and the document after each of its records.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/document/journal.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {

inline const std::vector<std::string> kSession{
    R"({"edit":"select","expr":"1-10"})",
    R"({"edit":"translate","by":[0.1,0,1.1]})",
    R"({"edit":"grow","rings":2})",
    R"({"edit":"lift","distance":0.3})",
    R"({"edit":"undo"})",
    R"({"edit":"undo"})",
    R"({"edit":"redo"})",
    R"({"edit":"select","expr":"3","kind":"element","mode":"set"})",
    R"({"edit":"lock","on":"1"})",
};

inline Document small() { return make_sheet(5, 4); }

/// Applies and journals one edit, as modeld does.
inline Result<EditReport> work(Document& document, Journal& journal, const std::string& json) {
  const Edit edit = edit_of(json);
  Result<Prepared> prepared = prepare(document, edit);
  if (!prepared) return fail(prepared.error());
  if (const Result<void> kept = journal.append(document, edit, *prepared); !kept) return fail(kept.error());
  EditReport report = prepared->report;
  commit(document, std::move(*prepared));
  return report;
}

/// A journal of the whole session, and the document after each of its records.
struct Session {
  Folder folder;
  std::filesystem::path path = folder / "session.journal";
  std::vector<Document> after;     ///< [k]: after k records
  std::vector<std::size_t> bytes;  ///< [k]: size of the journal then

  explicit Session(const std::vector<std::string>& edits = kSession, Document document = small()) {
    Result<Journal> journal = Journal::create(path, document);
    EXPECT_TRUE(journal) << journal.error().text();
    after.push_back(document);
    bytes.push_back(std::filesystem::file_size(path));
    for (const std::string& edit : edits) {
      const Result<EditReport> report = work(document, *journal, edit);
      EXPECT_TRUE(report) << edit << ": " << report.error().text();
      after.push_back(document);
      bytes.push_back(std::filesystem::file_size(path));
    }
    EXPECT_EQ(journal->records(), edits.size());
  }
};

/// The copies of damaged journals that lie beside one.
inline std::vector<std::string> copies_of(const std::filesystem::path& journal) {
  std::vector<std::string> copies;
  for (const auto& entry : std::filesystem::directory_iterator(journal.parent_path()))
    if (entry.path().string().starts_with(journal.string() + ".damaged.")) copies.push_back(content_of(entry.path()));
  return copies;
}

}  // namespace prismesh::mesh::document
