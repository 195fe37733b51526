#include "daemon/intake/access/access.h"

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/daemon/intake/store_rig.h"

namespace prismesh::intake {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TokensAndPairing : public ::testing::Test {
 protected:
  TokensAndPairing() {
    std::string name = (fs::temp_directory_path() / "prismesh_access_XXXXXX").string();
    root_ = ::mkdtemp(name.data());
    reopen();
  }
  ~TokensAndPairing() override { fs::remove_all(root_); }

  Result<std::unique_ptr<Access>> open() {
    notes_.clear();
    return Access::open(
        *ipc::store::Folder::open(root_), limits_, clock_, [this] { return now_s_; }, counted_randomness(++lives_), notes_);
  }
  void reopen() {
    access_.reset();
    Result<std::unique_ptr<Access>> opened = open();
    ASSERT_TRUE(opened) << opened.error().text();
    access_ = std::move(*opened);
  }
  Result<NewToken> pair(const std::string& name, const std::array<std::uint8_t, 10>& secret) {
    return access_->pair(ipc::encode_pairing_secret(secret), name);
  }
  std::string token(const std::string& name) { return pair(name, access_->make_secret({"", Scopes::all()}))->token; }
  bool is_known(const std::string& token) { return access_->caller_of(token).has_value(); }
  std::string text_of(const char* file) const {
    std::stringstream text;
    text << std::ifstream(root_ / file).rdbuf();
    return std::move(text).str();
  }

  AccessLimits limits_;
  ManualClock clock_;
  std::int64_t now_s_ = 1'800'000'000;
  std::uint64_t lives_ = 0;
  fs::path root_;
  std::vector<std::string> notes_;
  std::unique_ptr<Access> access_;
};

TEST_F(TokensAndPairing, keep_no_token_only_its_hash) {
  const std::string token = this->token("ann");
  EXPECT_EQ(token.size(), 3 + 64u) << "256 bits";
  EXPECT_THAT(text_of("tokens"), ::testing::AllOf(HasSubstr(ipc::store::sha256(token).hex()), ::testing::Not(HasSubstr(token.substr(3)))));
  EXPECT_EQ(fs::status(root_ / "tokens").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  reopen();
  ASSERT_TRUE(is_known(token));
  EXPECT_EQ(access_->caller_of(token)->name, "ann");
  EXPECT_FALSE(is_known(token + "0"));
  EXPECT_FALSE(is_known(ipc::store::sha256(token).hex())) << "the hash isn't a token";
}

TEST_F(TokensAndPairing, codes_expire_by_a_clock_that_nobody_sets) {
  const auto secret = access_->make_secret({"", Scopes::all()});
  now_s_ += 1'000'000;
  clock_.advance_ns(299'000'000'000);
  const auto late = secret;
  clock_.advance_ns(1'000'000'000);
  EXPECT_FALSE(pair("ann", late));
}

TEST_F(TokensAndPairing, a_new_code_voids_the_one_before) {
  const auto first = access_->make_secret({"", Scopes::all()});
  const auto second = access_->make_secret({"", Scopes::all()});
  EXPECT_FALSE(pair("ann", first));
  EXPECT_TRUE(pair("ann", second));
}

TEST_F(TokensAndPairing, a_code_takes_ten_wrong_secrets) {
  auto secret = access_->make_secret({"", Scopes::all()});
  const auto right = secret;
  secret[0] ^= 1;
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(pair("ann", secret));
  EXPECT_TRUE(pair("ann", right));
  const auto next = access_->make_secret({"", Scopes::all()});
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(pair("bob", secret));
  EXPECT_FALSE(pair("bob", next));
}

TEST_F(TokensAndPairing, strangers_cannot_fill_the_audit_log) {
  const auto before = fs::file_size(root_ / "audit.log");
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(pair("ann", {}));
  EXPECT_EQ(fs::file_size(root_ / "audit.log"), before);
}

TEST_F(TokensAndPairing, names_are_of_one_token_each) {
  token("ann");
  const auto secret = access_->make_secret({"", Scopes::all()});
  EXPECT_THAT(pair("ann", secret).error().text(), HasSubstr("has a token already"));
  for (const std::string& bad : {std::string(), std::string("a\nb"), std::string(65, 'a'), std::string(" a"), std::string("\xff")})
    EXPECT_FALSE(pair(bad, secret)) << bad;
  EXPECT_TRUE(pair("bob", secret)) << "a bad name doesn't use the code up";
}

TEST_F(TokensAndPairing, an_offer_s_own_name_counts) {
  const auto secret = access_->make_secret({"the line", Scopes::all()});
  EXPECT_EQ(pair("another", secret)->record.name, "the line");
}

TEST_F(TokensAndPairing, tokens_expire_for_good_even_if_the_clock_is_set_back) {
  const std::string token = this->token("ann");
  now_s_ += limits_.token_lifetime_s - 1;
  EXPECT_TRUE(is_known(token));
  now_s_ += 1;
  EXPECT_FALSE(is_known(token));
  now_s_ -= 100'000;
  EXPECT_FALSE(is_known(token));
}

TEST_F(TokensAndPairing, revoked_tokens_are_gone_at_once_and_after_a_restart) {
  const std::string token = this->token("ann");
  const Caller caller = *access_->caller_of(token);
  EXPECT_TRUE(access_->still_may(caller, Scope::upload));
  ASSERT_TRUE(access_->revoke("ann"));
  EXPECT_FALSE(access_->revoke("ann"));
  EXPECT_FALSE(access_->still_may(caller, Scope::upload));
  EXPECT_FALSE(is_known(token));
  reopen();
  EXPECT_FALSE(is_known(token));
}

TEST_F(TokensAndPairing, have_a_rate_that_comes_back) {
  limits_.requests_at_once = 3;
  limits_.requests_per_s = 1;
  reopen();
  const std::string token = this->token("ann");
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(is_known(token));
  EXPECT_EQ(access_->caller_of(token).error(), Denial::too_many_requests);
  clock_.advance_ns(1'000'000'000);
  EXPECT_TRUE(is_known(token));
  EXPECT_FALSE(is_known(token));
}

TEST_F(TokensAndPairing, a_damaged_list_lets_nobody_in) {
  token("ann");
  std::string text = text_of("tokens");
  text[text.size() / 2] ^= 1;
  std::ofstream(root_ / "tokens") << text;
  EXPECT_THAT(open().error().text(), HasSubstr("the list of tokens is damaged"));
}

TEST_F(TokensAndPairing, each_line_of_the_audit_log_vouches_for_those_before) {
  token("ann");
  access_->note("ann", "published", "abc");
  ASSERT_TRUE(access_->revoke("ann"));
  const std::string text = text_of("audit.log");
  const Result<AuditChain> chain = check_audit(text, "audit.log");
  ASSERT_TRUE(chain) << chain.error().text();
  EXPECT_EQ(chain->lines, 4u);
  EXPECT_EQ(chain->whole_bytes, text.size());
  for (const char* word : {"paired", "published", "revoked"}) EXPECT_THAT(text, HasSubstr(word));
  std::size_t caught = 0;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    std::string changed = text;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    const Result<AuditChain> found = check_audit(changed, "audit.log");
    caught += !found || found->lines < 4 ? 1 : 0;
  }
  EXPECT_EQ(caught, text.size() - 1) << "every byte that is changed is noticed";
  const std::size_t second = text.find('\n') + 1;
  EXPECT_EQ(check_audit(text.substr(0, second) + text.substr(text.find('\n', second) + 1), "audit.log").error().line, 2)
      << "a line taken out";
}

TEST_F(TokensAndPairing, a_line_that_was_cut_off_is_told_and_the_log_goes_on) {
  token("ann");
  access_.reset();
  fs::resize_file(root_ / "audit.log", fs::file_size(root_ / "audit.log") - 5);
  reopen();
  EXPECT_THAT(notes_, ::testing::ElementsAre(HasSubstr("cut off")));
  access_->note("bob", "published", "x");
  EXPECT_TRUE(check_audit(text_of("audit.log"), "audit.log"));
  access_.reset();
  std::ofstream(root_ / "audit.log", std::ios::app) << "a line of somebody else\n";
  EXPECT_THAT(open().error().text(), HasSubstr("audit.log:3: the audit log was changed"));
}

}  // namespace
}  // namespace prismesh::intake
