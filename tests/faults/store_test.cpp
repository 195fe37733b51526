// The store of models under kills, power cuts and failing calls, at each of its file calls: a model is there whole or not at all, what was
// acknowledged stays, and the store goes on afterwards.
#include <cerrno>
#include <cstdio>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "ipc/store/record_text.h"
#include "tests/daemon/intake/store_rig.h"
#include "tests/faults/power_cut.h"
#include "tests/faults/session.h"
#include "tests/support/seed.h"

namespace prismesh::intake {
namespace {

namespace fs = std::filesystem;
using modeld::faults::Root;
using test::DiskState;
using test::Failure;
using test::FileCall;
using test::Survives;

const std::string& door_text() {
  static const std::string kText(3000, 'd');
  return kText;
}
SetFiles first_car() { return {{"car.k", "*INCLUDE\nparts/door.k\n"}, {"parts/door.k", door_text()}}; }
SetFiles second_car() { return {{"car.k", "*INCLUDE\nparts/door.k\n$ edited\n"}, {"parts/door.k", door_text()}}; }
ipc::store::ContentHash hash_of(const SetFiles& files) { return ipc::store::model_hash(publication_of("ann", files, "car.k").manifest); }

/// All models of a store with their files, as text that can be compared.
std::string models_in(Store& store, const fs::path& path) {
  std::string text;
  const auto listed = store.list({"", {}, 0, 1000});
  if (!listed) return "no catalogue: " + listed.error().error.text();
  std::map<std::string, CatalogueEntry> by_hash;
  for (const CatalogueEntry& entry : *listed) by_hash[entry.record.model.hex()] = entry;
  for (const auto& [model, entry] : by_hash) {
    text += ipc::store::record_json(entry.record) + (entry.damaged ? " damaged" : "") + "\n";
    for (const auto& [file, content] : files_of(path, entry.record.model)) text += file + ": " + content + "\n";
  }
  return text;
}

Outcome<void> done(const auto& outcome) {
  if (!outcome) return tl::unexpected(outcome.error());
  return {};
}

/// An upload in checked chunks, the first of which is sent wrong.
Outcome<std::string> upload_checked(Store& store, const std::string& text) {
  const auto begun = store.begin_upload({"ann", text.size(), "", ipc::store::sha256(text)});
  if (!begun) return tl::unexpected(begun.error());
  const std::size_t half = text.size() / 2;
  for (const auto& [at, sent] : {std::pair{std::size_t{0}, std::string(half, 'x')}, std::pair{std::size_t{0}, text.substr(0, half)},
                                 std::pair{half, text.substr(half)}}) {
    const auto hash = ipc::store::sha256(text.substr(at, sent.size()));
    const auto chunk = store.uploads().begin_chunk("ann", begun->id, at,
                                                   Checksum{ChecksumAlgorithm::sha256, std::string(hash.bytes.begin(), hash.bytes.end())});
    if (!chunk) return tl::unexpected(chunk.error());
    if (const auto added = store.uploads().add(begun->id, *chunk, sent); !added) return tl::unexpected(added.error());
    const auto ended = store.uploads().end_chunk(begun->id, *chunk);
    if (!ended && ended.error().why != Refusal::wrong_checksum) return tl::unexpected(ended.error());
  }
  return begun->id;
}

struct Step {
  std::string name;
  std::function<Outcome<void>(Store&)> run;
};

const std::vector<Step>& steps() {
  static const std::vector<Step> kSteps{
      {"upload and publish", [](Store& store) { return done(publish(store, "ann", first_car(), "car.k")); }},
      {"publish another that shares a file",
       [](Store& store) {
         const auto sent = upload_checked(store, second_car().at("car.k"));
         if (!sent) return done(sent);
         Publication publication = publication_of("ann", second_car(), "car.k");
         publication.may_use_stored = true;
         publication.derived_from = hash_of(first_car());
         return done(store.publish(publication));
       }},
      {"describe",
       [](Store& store) {
         return done(store.describe(hash_of(second_car()), {100, 90, 3, 2, 1}, "a picture"));
       }},
      {"describe anew",
       [](Store& store) {
         return done(store.describe(hash_of(second_car()), {100, 90, 3, 0, 0}, "another picture"));
       }},
      {"remove", [](Store& store) { return store.remove(hash_of(first_car())); }},
      {"publish the first again", [](Store& store) { return done(publish(store, "ann", first_car(), "car.k")); }},
  };
  return kSteps;
}

StoreLimits fault_limits() {
  StoreLimits limits;
  limits.reserved_bytes = 0;
  return limits;
}

/// Whatever was interrupted, the store takes a model again and keeps it.
void expect_goes_on(Store& store, const fs::path& path) {
  const SetFiles files{{"new.k", "a new model"}};
  const auto record = publish(store, "bob", files, "new.k");
  ASSERT_TRUE(record) << record.error().error.text();
  ASSERT_EQ(files_of(path, record->model), files);
}

TEST(StoreFaults, leave_each_model_whole_after_a_power_cut) {
  const Root root;
  ManualClock clock;
  const fs::path path = root.disk() / "store";
  const DiskState before = test::disk_state_of(root.disk());
  std::vector<std::string> states{""};
  test::record_file_calls(root.disk(), root.log());
  {
    Result<Store> store = open_store(path, clock, fault_limits());
    ASSERT_TRUE(store) << store.error().text();
    for (const Step& step : steps()) {
      const Outcome<void> went = step.run(*store);
      ASSERT_TRUE(went) << step.name << ": " << went.error().error.text();
      test::mark_file_calls(states.size());
      states.push_back(models_in(*store, path));
    }
  }
  test::stop_recording_file_calls();
  const std::vector<FileCall> calls = test::read_file_calls(root.log());
  std::mt19937_64 random(test::seed(1));
  std::set<std::string> seen;
  for (int round = 0; round < 4; ++round)
    for (std::size_t count = 0; count <= calls.size(); ++count)
      for (const Survives survives : {Survives::all, Survives::flushed, Survives::in_order, Survives::any}) {
        if (round > 0 && (survives == Survives::all || survives == Survives::flushed)) continue;
        SCOPED_TRACE("after " + std::to_string(count) + " calls, " + std::to_string(static_cast<int>(survives)));
        const DiskState state = test::after_power_cut(before, calls, count, survives, random);
        std::size_t acknowledged = 0;
        for (std::size_t i = 0; i < count; ++i) acknowledged += calls[i].kind == FileCall::Kind::mark ? 1 : 0;
        std::string key = std::to_string(acknowledged);
        for (const auto& [file, content] : state.files) key += "\n" + file + "\n" + content;
        if (!seen.insert(std::move(key)).second) continue;
        test::restore(state);
        Result<Store> store = open_store(path, clock, fault_limits(), nullptr, 2 + seen.size());
        ASSERT_TRUE(store) << store.error().text();
        const std::string found = models_in(*store, path);
        ASSERT_TRUE(found == states[acknowledged] || (acknowledged < steps().size() && found == states[acknowledged + 1]))
            << "acknowledged: " << acknowledged << "\n"
            << found << "\nexpected\n"
            << states[acknowledged];
        expect_goes_on(*store, path);
        if (HasFatalFailure()) return;
      }
  EXPECT_GE(seen.size(), 500u);
  std::printf("%zu states of the disk, %zu calls\n", seen.size(), calls.size());
}

/// Runs all steps with a failure; the number of calls.
std::uint64_t run_with(const Root& root, const DiskState& before, const std::vector<std::string>& went_well, const Failure& failure) {
  ManualClock clock;
  const fs::path path = root.disk() / "store";
  test::restore(before);
  // What each step's end may have left: of a refused one its beginning or its end.
  std::set<std::string> possible{""};
  test::record_file_calls(root.disk(), root.log(), failure);
  {
    Result<Store> store = open_store(path, clock, fault_limits());
    for (std::size_t i = 0; store && i < steps().size(); ++i) {
      const Outcome<void> went = steps()[i].run(*store);
      if (went) possible = {went_well[i + 1]};
      if (went) continue;
      EXPECT_FALSE(went.error().error.message.empty());
      possible.insert(went_well[i + 1]);
      break;  // the next step builds on this one
    }
  }
  const std::uint64_t calls = test::counted_file_calls();
  test::stop_recording_file_calls();
  Result<Store> again = open_store(path, clock, fault_limits(), nullptr, 2);
  EXPECT_TRUE(again) << again.error().text();
  if (!again) return calls;
  const std::string found = models_in(*again, path);
  EXPECT_TRUE(possible.contains(found)) << found;
  expect_goes_on(*again, path);
  return calls;
}

TEST(StoreFaults, leave_each_model_whole_after_any_failing_call) {
  const Root root;
  ManualClock clock;
  const DiskState before = test::disk_state_of(root.disk());
  std::vector<std::string> went_well{""};
  {
    const fs::path path = root.disk() / "store";
    Result<Store> store = open_store(path, clock, fault_limits());
    for (const Step& step : steps()) {
      ASSERT_TRUE(step.run(*store));
      went_well.push_back(models_in(*store, path));
    }
  }
  const std::uint64_t calls = run_with(root, before, went_well, {});
  ASSERT_FALSE(HasFailure());
  ASSERT_GT(calls, 100u);
  for (std::uint64_t at = 1; at <= calls; ++at)
    for (const Failure& failure : {Failure{at, EIO, false, false}, Failure{at, ENOSPC, true, false}, Failure{at, ENOSPC, true, true}}) {
      SCOPED_TRACE("call " + std::to_string(at) + (failure.for_ever ? " and all after it" : "") + (failure.cut_short ? ", half done" : ""));
      run_with(root, before, went_well, failure);
      if (HasFailure()) return;
    }
  std::printf("%llu runs with a failing call\n", static_cast<unsigned long long>(3 * calls));
}

}  // namespace
}  // namespace prismesh::intake
