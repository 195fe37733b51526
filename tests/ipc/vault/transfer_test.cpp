#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/progress.h"
#include "ipc/store/receiving.h"
#include "ipc/vault/fetch.h"
#include "ipc/vault/objects.h"
#include "ipc/vault/push.h"
#include "tests/ipc/vault/memory_store.h"

namespace prismesh::ipc::vault {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class VaultTransfer : public ::testing::Test {
 protected:
  VaultTransfer() {
    std::string name = (fs::temp_directory_path() / "vault-XXXXXX").string();
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    std::mt19937 dice(7);
    for (std::size_t i = 0; i < large_.size(); ++i) large_[i] = static_cast<char>(dice());
    write("main.k", "main");
    write("parts/large.bin", large_);
    write("parts/again.k", "main");
    write("parts/empty.k", "");
  }
  ~VaultTransfer() override { fs::remove_all(folder_); }

  void write(const std::string& path, const std::string& text) {
    fs::create_directories((folder_ / "source" / path).parent_path());
    std::ofstream(folder_ / "source" / path, std::ios::binary) << text;
    std::erase_if(files_, [&](const store::LocalFile& file) { return file.path == path; });
    files_.push_back({folder_ / "source" / path, path});
  }
  static std::string read(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }
  Result<VaultPushed> push(Vault vault, const std::string& name = "a name") const {
    VaultPushOptions options;
    options.name = name;
    options.now_s = 1000;
    return vault::push(vault, files_, "main.k", options);
  }
  Result<VaultFetched> fetch(Vault vault, const std::string& wanted = "a name") const {
    return vault::fetch(vault, wanted, {folder_ / "back", {}});
  }
  void expect_back() const {
    for (const store::LocalFile& file : files_) EXPECT_EQ(read(folder_ / "back" / file.path), read(file.disk)) << file.path;
    EXPECT_FALSE(fs::exists(folder_ / "back.fetching"));
  }

  std::string large_ = std::string(kPieceBytes + 1000, '\0');
  fs::path folder_;
  std::vector<store::LocalFile> files_;
  MemoryStore store_;
};

TEST_F(VaultTransfer, sends_each_piece_once_and_the_manifest_last) {
  const Result<VaultPushed> pushed = push(store_.vault());
  ASSERT_TRUE(pushed) << pushed.error().text();
  EXPECT_EQ(pushed->pieces, 3u);
  EXPECT_EQ(pushed->sent_pieces, 3u);
  EXPECT_EQ(store_.count("PUT"), 6u) << "pieces, the list of the large file, the name, the manifest";
  EXPECT_EQ(store_.requests().back().target, "/bucket/f/" + model_object(pushed->model.model));
  for (const SeenRequest& request : store_.requests()) {
    EXPECT_THAT(request.head, HasSubstr("x-amz-content-sha256: " + store::sha256(request.body).hex()));
    EXPECT_THAT(request.head, HasSubstr("Authorization: AWS4-HMAC-SHA256 Credential=key/"));
    EXPECT_THAT(request.head, HasSubstr("/here/s3/aws4_request"));
  }
  for (const auto& [key, bytes] : store_.objects()) {
    if (key.starts_with("f/pieces/") || key.starts_with("f/models/")) {
      EXPECT_EQ(store::sha256(bytes).hex(), key.substr(9));
    }
  }
  ASSERT_TRUE(fetch(store_.vault()));
  expect_back();
  const Result<VaultPushed> again = push(store_.vault(), "another");
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->was_there);
  EXPECT_EQ(store_.count("PUT"), 7u) << "only the other name";
}

TEST_F(VaultTransfer, lists_go_on_where_they_are_cut) {
  for (int i = 0; i < 5; ++i) {
    write("main.k", "main " + std::to_string(i));
    ASSERT_TRUE(push(store_.vault(), "model " + std::to_string(i)));
  }
  Vault vault = store_.vault();
  const Result<std::vector<store::ModelRecord>> all = models(vault);
  ASSERT_TRUE(all) << all.error().text();
  EXPECT_EQ(all->size(), 5u);
  store_.answer_instead([](const SeenRequest& request) -> std::optional<std::string> {
    if (request.target.find("list-type") == std::string::npos) return std::nullopt;
    return MemoryStore::answer(
        "200 OK", "<ListBucketResult><IsTruncated>true</IsTruncated><NextContinuationToken>a</NextContinuationToken></ListBucketResult>");
  });
  EXPECT_THAT(models(vault).error().text(), HasSubstr("lists the same objects again and again"));
  store_.answer_instead([pages = 0](const SeenRequest& request) mutable -> std::optional<std::string> {
    if (request.target.find("list-type") == std::string::npos) return std::nullopt;
    return MemoryStore::answer("200 OK", "<ListBucketResult><IsTruncated>true</IsTruncated><NextContinuationToken>" +
                                             std::to_string(++pages) + "</NextContinuationToken></ListBucketResult>");
  });
  EXPECT_THAT(models(vault).error().text(), HasSubstr("lists more than 500 times"));
}

TEST_F(VaultTransfer, lists_have_an_end) {
  store_.answer_instead([pages = 0](const SeenRequest&) mutable -> std::optional<std::string> {
    std::string body = "<ListBucketResult><IsTruncated>true</IsTruncated><NextContinuationToken>" + std::to_string(++pages % 2) +
                       "</NextContinuationToken>";
    for (int i = 0; i < 30'000; ++i) body += "<Contents><Key>f/names/a</Key><Size>1</Size></Contents>";
    return MemoryStore::answer("200 OK", body + "</ListBucketResult>");
  });
  Vault vault = store_.vault();
  const Result<std::vector<ListedObject>> listed = vault.list(kNames);
  ASSERT_FALSE(listed);
  EXPECT_THAT(listed.error().text(), HasSubstr("has more than 200000 objects named names/"));
  EXPECT_EQ(listed.error().kind, ErrorKind::over_limit);
  EXPECT_EQ(store_.requests().size(), 7u);
}

TEST_F(VaultTransfer, a_model_keeps_its_names) {
  const auto named_by = [this](const std::string& name, std::int64_t now_s) {
    Vault vault = store_.vault();
    VaultPushOptions options;
    options.name = name;
    options.now_s = now_s;
    const Result<VaultPushed> pushed = vault::push(vault, files_, "main.k", options);
    EXPECT_TRUE(pushed);
    return pushed ? pushed->model : store::ModelRecord();
  };
  const auto listed = [this] {
    Vault vault = store_.vault();
    const Result<std::vector<store::ModelRecord>> all = models(vault);
    return all && all->size() == 1 ? all->front().name : "not one model";
  };
  EXPECT_EQ(named_by("first", 1000).name, "first");
  EXPECT_EQ(named_by("", 2000).name, "first") << "a push without a name doesn't rename";
  EXPECT_EQ(listed(), "first");
  EXPECT_EQ(named_by("second", 2000).when_s, 2000);
  EXPECT_EQ(named_by("third", 2000).when_s, 2001) << "in the same second";
  EXPECT_EQ(listed(), "third");
  const store::ModelRecord again = named_by("first", 3000);
  EXPECT_EQ(again.when_s, 3000) << "an old name is taken again";
  EXPECT_EQ(listed(), "first");
  const std::size_t before = store_.count("PUT");
  EXPECT_EQ(named_by("first", 4000), again);
  EXPECT_EQ(store_.count("PUT"), before);
  store::ModelRecord future = again;
  future.name = "future";
  future.when_s = 99'000'000'000;
  store_.put("f/" + name_object(future), "future");
  EXPECT_EQ(listed(), "first") << "a time in the future counts for nothing";
  for (const char* name : {"first", "second", "third", "future"}) {
    Vault vault = store_.vault();
    const Result<store::ModelRecord> found = find_model(vault, name);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->model, again.model);
  }
  // A name that another model has now is that one's.
  write("main.k", "other");
  const store::ModelRecord other = named_by("second", 5000);
  Vault vault = store_.vault();
  EXPECT_EQ(find_model(vault, "second")->model, other.model);
}

TEST_F(VaultTransfer, a_push_mends_a_list_and_a_manifest_of_the_same_size) {
  const Result<VaultPushed> pushed = push(store_.vault());
  ASSERT_TRUE(pushed);
  for (const std::string& object : {list_object(store::sha256(large_)), model_object(pushed->model.model)}) {
    const std::string sound = store_.objects().at("f/" + object);
    for (const std::string& damaged : {std::string(sound.size(), 'x'), sound + "x"}) {
      store_.put("f/" + object, damaged);
      ASSERT_FALSE(fetch(store_.vault()));
      const Result<VaultPushed> again = push(store_.vault());
      ASSERT_TRUE(again) << again.error().text();
      EXPECT_FALSE(again->was_there);
      EXPECT_EQ(store_.objects().at("f/" + object), sound);
    }
  }
  EXPECT_TRUE(push(store_.vault())->was_there);
  int wrong = 2;
  store_.answer_instead([&wrong](const SeenRequest& request) -> std::optional<std::string> {
    if (request.target.find("/lists/") == std::string::npos || wrong-- <= 0) return std::nullopt;
    return MemoryStore::answer("200 OK", "prismesh-pieces 2\n");
  });
  ASSERT_TRUE(fetch(store_.vault())) << "a line may change a list";
  expect_back();
}

TEST_F(VaultTransfer, a_file_that_changes_is_not_sent) {
  store_.answer_instead([this](const SeenRequest& request) -> std::optional<std::string> {
    if (request.method == "HEAD") std::ofstream(folder_ / "source/main.k") << "other";
    return std::nullopt;
  });
  const Result<VaultPushed> pushed = push(store_.vault());
  ASSERT_FALSE(pushed);
  EXPECT_THAT(pushed.error().text(), HasSubstr("changed while it was sent; push it again"));
  EXPECT_TRUE(store_.objects().empty());
}

TEST_F(VaultTransfer, what_a_store_says_wrongly_is_refused) {
  ASSERT_TRUE(push(store_.vault()));
  struct Lie {
    const char* of;  ///< part of the target
    std::string answer;
    const char* words;
  };
  const std::string other(4, 'x');
  const std::vector<Lie> lies{
      {"/pieces/", MemoryStore::answer("200 OK", other), "than its name says"},
      {"/pieces/", MemoryStore::answer("200 OK", std::string(kPieceBytes + 1, 'x')), "an object is longer than it was"},
      {"/models/", MemoryStore::answer("200 OK", std::string(store::kMaxManifestBytes + 1, 'x')), "an object is longer than it was"},
      {"/models/", MemoryStore::answer("200 OK", "prismesh-set 1\n"), "gives other bytes for models/"},
      {"/lists/", MemoryStore::answer("200 OK", "prismesh-pieces 1\n"), "--resend"},
      {"/lists/", MemoryStore::answer("200 OK", encode_pieces(std::vector{store::sha256("main"), store::sha256("main")})),
       "isn't right; push the model again with --resend"},
      {"/lists/", MemoryStore::refusal("404 No", "NoSuchKey"), "isn't there; push the model again"},
      {"/pieces/", MemoryStore::refusal("404 No", "NoSuchKey"), "isn't there; push the model again"},
      {"list-type", MemoryStore::answer("200 OK", "<html/>"), "is no list of objects"},
      {"list-type", MemoryStore::refusal("404 No", "NoSuchBucket"), "there is no bucket 'bucket'"},
      {"list-type", MemoryStore::refusal("403 No", "RequestTimeTooSkewed"), "clock"},
      {"list-type", MemoryStore::refusal("400 No", "AuthorizationHeaderMalformed"), "another region"},
      {"list-type", MemoryStore::answer("301 No", "", "Location: http://127.0.0.1:1/\r\n"), "another region or address (status 301)"},
      {"list-type", MemoryStore::refusal("403 No", "AccessDenied"), "refuses these keys, or they may not do this (AccessDenied: words)"},
      {"list-type", MemoryStore::answer("418 Tea", "no XML"), "status 418"},
      {"list-type",
       "HTTP/1.1 200 OK\r\n" +
           [] {
             std::string many;
             for (int i = 0; i < 300; ++i) many += "X-" + std::to_string(i) + ": 1\r\n";
             return many;
           }() +
           "\r\n",
       "too many headers"},
      {"list-type", "no HTTP\r\n\r\n", "the request failed"},
  };
  for (const Lie& lie : lies) {
    store_.answer_instead([&lie](const SeenRequest& request) -> std::optional<std::string> {
      if (request.target.find(lie.of) == std::string::npos) return std::nullopt;
      return lie.answer;
    });
    const Result<VaultFetched> fetched = fetch(store_.vault(std::chrono::milliseconds(0)));
    ASSERT_FALSE(fetched) << lie.words;
    EXPECT_THAT(fetched.error().text(), HasSubstr(lie.words));
    EXPECT_FALSE(fs::exists(folder_ / "back"));
  }
  store_.answer_instead({});
  ASSERT_TRUE(fetch(store_.vault()));
  expect_back();
}

TEST_F(VaultTransfer, a_list_of_other_pieces_is_noticed_at_the_end) {
  ASSERT_TRUE(push(store_.vault()));
  const std::string first = large_.substr(0, kPieceBytes), other(1000, 'y');
  store_.put("f/" + piece_object(store::sha256(other)), other);
  store_.put("f/" + list_object(store::sha256(large_)), encode_pieces(std::vector{store::sha256(first), store::sha256(other)}));
  EXPECT_THAT(fetch(store_.vault()).error().text(), HasSubstr("parts/large.bin: is damaged in the store"));
  EXPECT_FALSE(fs::exists(folder_ / "back"));
  Vault vault = store_.vault();
  const Result<Verified> verified = verify(vault, std::nullopt, {});
  ASSERT_TRUE(verified);
  ASSERT_EQ(verified->faults.size(), 1u);
  EXPECT_EQ(verified->faults[0].object, list_object(store::sha256(large_)));
  EXPECT_EQ(verified->faults[0].fault, "doesn't name the pieces of this file");
}

TEST_F(VaultTransfer, a_part_that_was_not_asked_for_is_refused) {
  ASSERT_TRUE(push(store_.vault()));
  store_.answer_instead([this](const SeenRequest& request) -> std::optional<std::string> {
    if (request.target.find(store::sha256(large_.substr(0, kPieceBytes)).hex()) == std::string::npos) return std::nullopt;
    if (request.head.find("Range: ") == std::string::npos)
      return MemoryStore::answer("200 OK", large_.substr(0, kPieceBytes)).substr(0, 5000);
    return MemoryStore::answer("206 Part", large_.substr(1, kPieceBytes), "Content-Range: bytes 1-9/10\r\n");
  });
  EXPECT_THAT(fetch(store_.vault()).error().text(), HasSubstr("another part of an object"));
  // A store that knows no parts gives the whole.
  store_.answer_instead([this](const SeenRequest& request) -> std::optional<std::string> {
    if (request.target.find(store::sha256(large_.substr(0, kPieceBytes)).hex()) == std::string::npos) return std::nullopt;
    const std::string whole = MemoryStore::answer("200 OK", large_.substr(0, kPieceBytes));
    return request.head.find("Range: ") == std::string::npos ? whole.substr(0, 5000) : whole;
  });
  ASSERT_TRUE(fetch(store_.vault()));
  expect_back();
}

TEST_F(VaultTransfer, tries_again_for_as_long_as_it_was_told) {
  int left = 3;
  store_.answer_instead([&left](const SeenRequest&) -> std::optional<std::string> {
    return left-- > 0 ? std::optional(MemoryStore::refusal("503 No", "SlowDown")) : std::nullopt;
  });
  EXPECT_TRUE(push(store_.vault()));
  store_.answer_instead([](const SeenRequest&) { return std::optional(MemoryStore::refusal("503 No", "SlowDown")); });
  EXPECT_THAT(push(store_.vault(std::chrono::milliseconds(20))).error().text(), HasSubstr("can't answer now (SlowDown: words)"));
  store_.answer_instead([](const SeenRequest& request) -> std::optional<std::string> {
    if (request.method != "PUT") return std::nullopt;
    return MemoryStore::refusal("400 No", "XAmzContentSHA256Mismatch");
  });
  write("main.k", "new");
  const std::size_t before = store_.count("PUT");
  EXPECT_THAT(push(store_.vault()).error().text(), HasSubstr("the line changes them"));
  EXPECT_EQ(store_.count("PUT") - before, 3u);
}

TEST_F(VaultTransfer, a_line_that_was_cut_or_silent_is_no_fault_of_the_bytes) {
  for (const char* code : {"RequestTimeout", "IncompleteBody"}) {
    write("main.k", code);
    int left = 8;
    store_.answer_instead([&left, code](const SeenRequest& request) -> std::optional<std::string> {
      return request.method != "HEAD" && left-- > 0 ? std::optional(MemoryStore::refusal("400 No", code)) : std::nullopt;
    });
    const Result<VaultPushed> pushed = push(store_.vault());
    ASSERT_TRUE(pushed) << pushed.error().text();
    left = 8;
    ASSERT_TRUE(fetch(store_.vault(), pushed->model.model.hex()));
    fs::remove_all(folder_ / "back");
    left = 1 << 30;
    EXPECT_THAT(push(store_.vault(std::chrono::milliseconds(20))).error().text(), HasSubstr(std::string("can't answer now (") + code));
  }
}

TEST_F(VaultTransfer, a_store_that_begins_anew_each_time_makes_no_progress) {
  ASSERT_TRUE(push(store_.vault()));
  const std::string first = large_.substr(0, kPieceBytes);
  std::atomic<int> tries{0};
  store_.answer_instead([&](const SeenRequest& request) -> std::optional<std::string> {
    if (request.target.find(store::sha256(first).hex()) == std::string::npos) return std::nullopt;
    // Two cuts in turn: each second try brings more than the one before, but never more than came already. Pauses grow only without
    // progress.
    return MemoryStore::answer("200 OK", first).substr(0, ++tries % 2 == 0 ? 9000 : 5000);
  });
  Vault vault = store_.vault(std::chrono::milliseconds(500), [&tries] { return tries > 30; });
  const Result<VaultFetched> fetched = vault::fetch(vault, "a name", {folder_ / "back", {}});
  ASSERT_FALSE(fetched);
  EXPECT_FALSE(is_cancelled(fetched.error()));
}

TEST_F(VaultTransfer, an_answer_that_is_cut_behind_its_last_byte_is_asked_for_whole) {
  ASSERT_TRUE(push(store_.vault()));
  int cuts = 1;
  store_.answer_instead([&cuts](const SeenRequest& request) -> std::optional<std::string> {
    if (request.target.find(piece_object(store::sha256("main"))) == std::string::npos) return std::nullopt;
    if (request.head.find("Range: bytes=4-") != std::string::npos) return MemoryStore::refusal("416 No", "InvalidRange");
    if (cuts-- <= 0) return std::nullopt;
    return "HTTP/1.1 200 OK\r\nConnection: close\r\nTransfer-Encoding: chunked\r\n\r\n4\r\nmain\r\n";
  });
  const Result<VaultFetched> fetched = fetch(store_.vault());
  ASSERT_TRUE(fetched) << fetched.error().text();
  expect_back();
}

TEST_F(VaultTransfer, a_fetch_stops_also_at_its_end) {
  ASSERT_TRUE(push(store_.vault()));
  Vault vault = store_.vault();
  const Result<VaultFetched> fetched =
      vault::fetch(vault, "a name", {folder_ / "back", [this](double) { return !fs::exists(folder_ / "back.fetching/whole"); }});
  ASSERT_FALSE(fetched);
  EXPECT_TRUE(is_cancelled(fetched.error())) << fetched.error().text();
  EXPECT_FALSE(fs::exists(folder_ / "back"));
  ASSERT_TRUE(fetch(store_.vault()));
  expect_back();
}

TEST(VaultRetrying, silence_counts_from_the_beginning_of_the_first_try) {
  const LineFault fault{Error{"store", 0, "it doesn't answer"}, true};
  Retrying retrying({std::chrono::seconds(60), std::chrono::milliseconds(1)}, {});
  const auto now = std::chrono::steady_clock::now();
  EXPECT_TRUE(retrying.wait_after(fault, now - std::chrono::seconds(30)));
  EXPECT_TRUE(retrying.wait_after(fault, now));
  retrying.line_is_good();
  EXPECT_FALSE(retrying.wait_after(fault, now - std::chrono::seconds(61)));
  retrying.line_is_good();
  EXPECT_TRUE(retrying.wait_after(fault));
}

TEST_F(VaultTransfer, tells_what_a_store_says_about_its_place) {
  store_.answer_instead([](const SeenRequest& request) -> std::optional<std::string> {
    if (request.method == "HEAD") return MemoryStore::answer("400 No", "");  // Amazon says no more to those
    return MemoryStore::answer("301 No", "<Error><Code>PermanentRedirect</Code><Endpoint>b.s3.eu.example.com</Endpoint></Error>",
                               "x-amz-bucket-region: eu-central-1\r\n");
  });
  const std::string told = push(store_.vault()).error().text();
  EXPECT_THAT(told, HasSubstr("set AWS_REGION=eu-central-1, or correct the address: its host is b.s3.eu.example.com"));
}

TEST_F(VaultTransfer, keys_that_are_lent_have_a_token_that_is_signed) {
  VaultSettings keys{std::nullopt, "here", "key", "secret", ""};
  keys.session_token = std::string(3000, 't');
  ASSERT_TRUE(push(Vault(store_.address(), keys, {}, {})));
  for (const SeenRequest& request : store_.requests()) {
    EXPECT_THAT(request.head, HasSubstr("x-amz-security-token: " + keys.session_token + "\r\n"));
    EXPECT_THAT(request.head, ::testing::ContainsRegex("SignedHeaders=[^,]*x-amz-security-token"));
  }
}

TEST_F(VaultTransfer, a_verification_takes_no_flipped_answer_for_damage) {
  ASSERT_TRUE(push(store_.vault()));
  int flips = 2;
  store_.answer_instead([&flips](const SeenRequest& request) -> std::optional<std::string> {
    if (request.target.find(piece_object(store::sha256("main"))) == std::string::npos || flips-- <= 0) return std::nullopt;
    return MemoryStore::answer("200 OK", "mbin");
  });
  Vault vault = store_.vault();
  EXPECT_TRUE(verify(vault, std::nullopt, {})->faults.empty());
  // Another model that says another size of the same file isn't sound because this one is.
  const std::string text = store::encode_manifest({"a.k", {{store::sha256("main"), 5, "a.k"}}});
  store_.put("f/" + model_object(store::model_hash(text)), text);
  const Result<Verified> verified = verify(vault, std::nullopt, {});
  ASSERT_EQ(verified->faults.size(), 1u);
  EXPECT_EQ(verified->faults[0].model, store::model_hash(text));
}

TEST_F(VaultTransfer, stops_when_it_is_told) {
  store_.answer_instead([](const SeenRequest&) { return std::optional(MemoryStore::refusal("503 No", "SlowDown")); });
  std::atomic<bool> stops{false};
  Vault vault = store_.vault(std::chrono::hours(1), [this, &stops] { return stops || store_.requests().size() > 2; });
  VaultPushOptions options;
  const Result<VaultPushed> pushed = vault::push(vault, files_, "main.k", options);
  ASSERT_FALSE(pushed);
  EXPECT_TRUE(is_cancelled(pushed.error()));
}

TEST_F(VaultTransfer, refuses_names_that_cannot_be_shown) {
  EXPECT_THAT(push(store_.vault(), "a\x1b[2J").error().text(), HasSubstr("a model's name is text"));
  EXPECT_THAT(push(store_.vault(), std::string(201, 'a')).error().text(), HasSubstr("at most 200 bytes"));
  EXPECT_THAT(push(store_.vault(), store::sha256("m").hex()).error().text(), HasSubstr("more than digits of a hash"));
  EXPECT_EQ(store_.requests().size(), 0u);
}

TEST_F(VaultTransfer, two_fetches_into_one_folder_do_not_mix) {
  ASSERT_TRUE(push(store_.vault()));
  std::string second;
  store_.answer_instead([&](const SeenRequest& request) -> std::optional<std::string> {
    if (request.target.find("/pieces/") != std::string::npos && second.empty()) {
      // The store answers one request at a time: the other fetch must be refused before it asks for a piece.
      const Result<store::Receiving> other = store::Receiving::begin(folder_ / "back", ".fetching");
      second = other ? "begun" : other.error().text();
    }
    return std::nullopt;
  });
  ASSERT_TRUE(fetch(store_.vault()));
  EXPECT_THAT(second, HasSubstr("another prismesh that fetches already runs here"));
  expect_back();
}

}  // namespace
}  // namespace prismesh::ipc::vault
