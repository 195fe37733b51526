#include "tests/faults/session.h"

#include <stdlib.h>

#include <algorithm>

#include <cmath>
#include <fstream>
#include <iterator>

#include "base/compression.h"
#include "base/hash.h"
#include "mesh/deck/open.h"
#include "mesh/document/edit_json.h"

namespace prismesh::modeld::faults {

namespace {

namespace fs = std::filesystem;

constexpr int kSide = 8;  ///< quads of the plate

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

/// Nodes of the plate's rows, 10 mm apart; the one in the middle is `lifted`.
std::string nodes_of_rows(int first, int end, double lifted = 0) {
  std::string text = "*NODE\n";
  char line[100];
  for (int j = first; j < end; ++j)
    for (int i = 0; i <= kSide; ++i) {
      std::snprintf(line, sizeof line, "%8d%16.6f%16.6f%16.6f\n", 1 + i + j * (kSide + 1), 10.0 * i, 10.0 * j,
                    i == kSide / 2 && j == kSide / 2 ? lifted : 0.0);
      text += line;
    }
  return text;
}

std::string shells_and_part() {
  std::string text = "*PART\npanel\n         1         1         1\n*ELEMENT_SHELL\n";
  char line[100];
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const int corner = 1 + i + j * (kSide + 1);
      std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", 1 + i + j * kSide, 1, corner, corner + 1, corner + kSide + 2,
                    corner + kSide + 1);
      text += line;
    }
  return text;
}

fs::path one_file(const fs::path& folder) {
  write(folder / "one.k", "*KEYWORD\n" + nodes_of_rows(0, kSide + 1) + shells_and_part() + "*END\n");
  return folder / "one.k";
}

fs::path three_files_of(const fs::path& folder, const std::string& name, double lifted) {
  write(folder / name, "*KEYWORD\n" + nodes_of_rows(0, 3) + "*INCLUDE\nparts/above.k\n*INCLUDE\nmesh/rest.k\n*END\n");
  write(folder / "parts/above.k", nodes_of_rows(3, 6, lifted));
  write(folder / "mesh/rest.k", nodes_of_rows(6, kSide + 1) + shells_and_part());
  return folder / name;
}

fs::path three_files(const fs::path& folder) { return three_files_of(folder, "main.k", 0); }

/// With another deck of the same includes where "copy" and "save as" write.
fs::path two_decks(const fs::path& folder) {
  three_files_of(folder / kSavedAs, kOtherDeck, 3);
  return three_files(folder);
}

fs::path packed(const fs::path& folder) {
  const std::string like("\x1f\x8b\x08\0\0\0\0\0\0\x03", 10);
  const std::string main = "*KEYWORD\n" + nodes_of_rows(0, 5) + "*INCLUDE\nrest.k.gz\n*END\n";
  const std::string rest = nodes_of_rows(5, kSide + 1) + shells_and_part();
  for (const auto& [name, content] : {std::pair("packed.k.gz", &main), std::pair("rest.k.gz", &rest)}) {
    const std::string_view piece = *content;
    write(folder / name, pack(std::span(&piece, 1), std::as_bytes(std::span(like))).value());
  }
  return folder / "packed.k.gz";
}

/// With a node pulled out, which repair corrects with other shells.
fs::path dented(const fs::path& folder) {
  write(folder / "plate.k", "*KEYWORD\n*INCLUDE\nnodes.k\n" + shells_and_part() + "*END\n");
  write(folder / "nodes.k", nodes_of_rows(0, kSide + 1, 9));
  return folder / "plate.k";
}

void put(std::string& text, const void* data, std::size_t size) { text.append(static_cast<const char*>(data), size); }

}  // namespace

Root::Root() {
  // Thousands of disks are written: to memory, where the machine lends some.
  const fs::path memory = "/dev/shm";
  std::string name = ((::access(memory.c_str(), W_OK) == 0 ? memory : fs::temp_directory_path()) / "prismesh-faults-XXXXXX").string();
  path_ = ::mkdtemp(name.data());
  fs::create_directories(disk() / "state");
  fs::permissions(disk() / "state", fs::perms::owner_all);
}

Root::~Root() {
  std::error_code problem;
  fs::remove_all(path_, problem);
}

std::string fingerprint(const DocumentKeeper& keeper) {
  const mesh::document::Generation& now = keeper.document().current();
  std::map<std::int64_t, std::string> nodes, shells;
  for (std::size_t n = 0; n < now.model.node_count(); ++n) {
    if (now.model.is_removed(mesh::NodeIndex(n))) continue;
    std::string& text = nodes[now.model.node_ids[n]];
    // A saved document is, after a restart, what its deck's columns can hold; the shift keeps round numbers off the border.
    for (const double x : now.model.positions[n]) text += std::to_string(std::llround(x * 1e4 + 0.1234)) + " ";
    text += static_cast<char>(now.node_marks[n]);
  }
  for (std::size_t s = 0; s < now.model.shell_count(); ++s) {
    if (now.model.is_removed(mesh::ShellIndex(s))) continue;
    std::string& text = shells[now.model.shell_ids[s]];
    for (const mesh::NodeIndex corner : now.model.shell_nodes[s].node) {
      const std::int64_t id = corner.valid() ? now.model.node_ids[corner.value] : 0;
      put(text, &id, sizeof id);
    }
    text += static_cast<char>(now.shell_marks[s]);
  }
  std::string all;
  for (const auto* entities : {&nodes, &shells})
    for (const auto& [id, text] : *entities) {
      put(all, &id, sizeof id);
      all += text;
    }
  for (const auto& part : *now.parts) all += std::to_string(part.hidden) + std::to_string(part.locked);
  return all;
}

Files deck_files(const Place& place) {
  Files files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(place.root)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || name.starts_with('.') || entry.path().string().starts_with(place.state().string())) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    files[entry.path().string()] = {std::istreambuf_iterator<char>(in), {}};
  }
  return files;
}

bool holds(const Files& found, const Files& recorded, const Place& place) {
  const std::string elsewhere = (place.root / kSavedAs).string();
  Files same = found;
  std::erase_if(same, [&](const auto& file) { return file.first.starts_with(elsewhere) && !recorded.contains(file.first); });
  return same == recorded;
}

Result<void> run_step(DocumentKeeper& keeper, const std::string& step) {
  if (step == "save") {
    const Result<ipc::Saved> saved = keeper.save(std::nullopt);
    return saved ? Result<void>() : fail(saved.error());
  }
  if (step == "save as" || step == "copy") {
    const std::string other = (keeper.document().path.parent_path() / kSavedAs / kOtherDeck).string();
    const Result<ipc::Saved> saved = step == "copy" ? keeper.save_copy(other) : keeper.save_as(other);
    return saved ? Result<void>() : fail(saved.error());
  }
  const Result<mesh::document::Edit> edit = mesh::document::parse_edit(step);
  if (!edit) return fail(edit.error());
  const Result<mesh::document::EditReport> done = keeper.edit(*edit);
  return done ? Result<void>() : fail(done.error());
}

Result<void> open_deck(DocumentKeeper& keeper, const Place& place) {
  ipc::Open request;
  request.path = place.deck.string();
  const Result<bool> opened = keeper.open(request, {});
  return opened ? Result<void>() : fail(opened.error());
}

Result<void> read_other_deck(const Place& place) {
  const fs::path other = place.root / kSavedAs / kOtherDeck;
  if (!fs::exists(other)) return {};
  const Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(other);
  if (!opened) return fail(opened.error());
  for (const mesh::deck::Warning& warning : opened->deck->warnings)
    if (warning.kind.starts_with("save-") && warning.kind != "save-finished") return fail(warning.file, warning.message);
  return {};
}

Result<void> reopen_deck(DocumentKeeper& keeper, const Place& place) {
  const Result<bool> reopened = keeper.reopen({});
  if (!reopened) return fail(reopened.error());
  return *reopened ? Result<void>() : open_deck(keeper, place);
}

const std::vector<Session>& sessions() {
  const std::vector<std::string> moves{
      R"({"edit":"select","expr":"1-30"})",
      R"({"edit":"translate","by":[0,0,0.25],"on":"1-60"})",
      R"({"edit":"translate","by":[0,0.125,0.5],"on":"30-81"})",
      R"({"edit":"lock","on":"1"})",
      "save",
      R"({"edit":"unlock","on":"1"})",
      R"({"edit":"translate","by":[0.01234567,0,0.3],"on":"all"})",
      R"({"edit":"undo"})",
      R"({"edit":"translate","by":[0,0.1,0],"on":"2,50,80"})",
      R"({"edit":"hide","on":"1"})",
      "save",
      R"({"edit":"show","on":"1"})",
      R"({"edit":"translate","by":[0,0,1],"on":"10-70"})",
  };
  static const std::vector<Session> kAll{
      {"one_file", one_file, moves},
      {"three_files", three_files, moves},
      {"packed", packed, moves},
      {"repaired",
       dented,
       {R"({"edit":"repair","scope":"all"})", R"({"edit":"select","expr":"20-30"})", "save", R"({"edit":"split","at":["shell:1"]})",
        R"({"edit":"undo"})", R"({"edit":"translate","by":[0,0,0.5],"on":"1"})", "save"}},
      {"saved_as",
       three_files,
       {R"({"edit":"translate","by":[0,0,0.25],"on":"1-60"})", R"({"edit":"select","expr":"1-30"})", R"({"edit":"lock","on":"1"})",
        "save as", R"({"edit":"unlock","on":"1"})", R"({"edit":"undo"})", R"({"edit":"undo"})",
        R"({"edit":"translate","by":[0,0.125,0.5],"on":"30-81"})", "save", R"({"edit":"translate","by":[0,0,1],"on":"10-70"})"}},
      {"saved_over",
       two_decks,
       {R"({"edit":"translate","by":[0,0,0.25],"on":"all"})", "copy", R"({"edit":"translate","by":[0,0,0.5],"on":"all"})", "copy",
        R"({"edit":"lock","on":"1"})", "save as", R"({"edit":"unlock","on":"1"})", R"({"edit":"translate","by":[0,0,1],"on":"10-70"})",
        "save"}},
  };
  return kAll;
}

Session session_by_chance(std::mt19937_64& random) {
  const auto up_to = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  const auto range = [&] {
    const int first = 1 + up_to(80);
    return std::to_string(first) + "-" + std::to_string(first + up_to(30));
  };
  const auto eighths = [&] { return std::to_string((up_to(64) - 32) / 8.0); };
  Session session = sessions()[static_cast<std::size_t>(up_to(static_cast<int>(sessions().size())))];
  session.name = "by_chance";
  session.by_chance = true;
  session.steps.clear();
  while (session.steps.size() < 24) {
    std::string step;
    switch (up_to(14)) {
      case 0: step = R"({"edit":"select","expr":")" + range() + "\"}"; break;
      case 1: step = R"({"edit":"lock","on":"1"})"; break;
      case 2: step = R"({"edit":"unlock","on":"1"})"; break;
      case 3: step = up_to(2) == 0 ? R"({"edit":"hide","on":"1"})" : R"({"edit":"show","on":"1"})"; break;
      case 4: step = R"({"edit":"split","at":["shell:)" + std::to_string(1 + up_to(64)) + "\"]}"; break;
      case 5:
      case 6: step = R"({"edit":"undo"})"; break;
      case 7: step = R"({"edit":"redo"})"; break;
      case 8:
      case 9: step = up_to(6) == 0 ? "save as" : "save"; break;
      default: step = R"({"edit":"translate","by":[)" + eighths() + "," + eighths() + "," + eighths() + R"(],"on":")" + range() + "\"}";
    }
    session.steps.push_back(std::move(step));
  }
  return session;
}

}  // namespace prismesh::modeld::faults
