#include <gtest/gtest.h>

#include "ipc/intake/messages_json.h"
#include "ipc/intake/pairing_code.h"
#include "ipc/intake/roles.h"

namespace prismesh::ipc {
namespace {

TEST(IntakeMessages, come_back_as_they_were) {
  const auto asked = decode_intake_request(encode_intake_request(4, MakePairingCode{"ann", {"read", "upload"}}).value());
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->number, 4U);
  EXPECT_EQ(std::get<MakePairingCode>(asked->request).name, "ann");
  EXPECT_EQ(std::get<MakePairingCode>(asked->request).scopes, (std::vector<std::string>{"read", "upload"}));
  const auto said = decode_from_intake(encode_intake_answer(4, Tokens{{{"ann", {"read"}, 5, 6}}}));
  ASSERT_TRUE(said);
  const TokenInfo& token = std::get<Tokens>(std::get<IntakeAnswer>(said->message)).tokens.at(0);
  EXPECT_EQ(token.name, "ann");
  EXPECT_EQ(token.scopes, (std::vector<std::string>{"read"}));
  EXPECT_EQ(token.expires_s, 6);
  const auto event = decode_from_intake(encode_intake_event(CatalogueChanged{"abc"}));
  ASSERT_TRUE(event);
  EXPECT_EQ(std::get<CatalogueChanged>(std::get<IntakeEvent>(event->message)).model, "abc");
}

TEST(IntakeMessages, need_their_fields) {
  const auto wrong = decode_intake_request(R"({"request":"make_pairing_code","number":3})");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("scopes"), std::string::npos);
}

TEST(IntakeRoles, who_watches_may_look_and_only_editors_let_others_in) {
  EXPECT_EQ(role_for(IntakeHello{}), Role::watch);
  EXPECT_EQ(role_for(GetIntake{}), Role::watch);
  EXPECT_EQ(role_for(MakePairingCode{}), Role::edit);
  EXPECT_EQ(role_for(GetTokens{}), Role::edit);
  EXPECT_EQ(role_for(RevokeToken{}), Role::edit);
  EXPECT_EQ(role_for(PublishWork{}), Role::offer);
  EXPECT_EQ(role_for(DescribeModel{}), Role::offer);
}

PairingCode some_code() {
  PairingCode code;
  for (std::size_t i = 0; i < 10; ++i) {
    code.fingerprint[i] = static_cast<std::uint8_t>(i * 25 + 3);
    code.secret[i] = static_cast<std::uint8_t>(255 - i * 11);
  }
  return code;
}

TEST(PairingCodeText, is_read_as_people_type_it) {
  const std::string text = encode_pairing_code(some_code());
  EXPECT_EQ(text.size(), 39u) << "32 signs and 7 hyphens: " << text;
  EXPECT_EQ(decode_pairing_code(text), some_code());
  std::string typed;
  for (const char c : text) typed += c == '-' ? ' ' : c == '0' ? 'o' : c == '1' ? 'l' : c >= 'A' ? static_cast<char>(c - 'A' + 'a') : c;
  EXPECT_EQ(decode_pairing_code(typed), some_code());
  EXPECT_EQ(decode_pairing_secret(encode_pairing_secret(some_code().secret)), some_code().secret);
  EXPECT_EQ(decode_pairing_secret(text.substr(20)), some_code().secret) << "it is the second half";
}

TEST(PairingCodeText, is_refused_where_it_is_none) {
  const std::string text = encode_pairing_code(some_code());
  for (const std::string& bad : {std::string(), text.substr(1), text + "0", "U" + text.substr(1), text.substr(0, 19), "é" + text})
    EXPECT_FALSE(decode_pairing_code(bad)) << bad;
  EXPECT_FALSE(decode_pairing_secret(text));
}

}  // namespace
}  // namespace prismesh::ipc
