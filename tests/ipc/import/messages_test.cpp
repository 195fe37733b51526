#include <gtest/gtest.h>

#include "ipc/import/messages_json.h"

namespace prismesh::ipc {
namespace {

TEST(ImportMessages, come_back_as_they_were) {
  Import request{kImportProtocol, "main.k", "/decks", {}};
  request.limits.nodes = 7;
  const auto decoded = decode_import_request(encode_import_request(request).value());
  ASSERT_TRUE(decoded) << decoded.error().text();
  const auto* read = std::get_if<Import>(&*decoded);
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(read->main, "main.k");
  EXPECT_EQ(read->shown_folder, "/decks");
  EXPECT_EQ(read->limits.nodes, 7u);
  EXPECT_EQ(read->limits.cpu_s, ImportLimits().cpu_s);
  const auto answer = decode_from_import(encode_import_answer(Imported{{"no Landlock"}}, 1));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->descriptors, 1u);
  EXPECT_EQ(std::get<Imported>(std::get<ImportAnswer>(answer->message)).unguarded.at(0), "no Landlock");
  const auto event = decode_from_import(encode_import_event(ImportProgress{0.5}));
  ASSERT_TRUE(event);
  EXPECT_EQ(std::get<ImportProgress>(std::get<ImportEvent>(event->message)).fraction, 0.5);
}

TEST(ImportMessages, to_rewrite_a_deck_come_back_as_they_were) {
  Rewrite request{{kImportProtocol, "main.k", "/decks", {}}, "0123456789abcdef0123456789abcdef"};
  request.limits.files = 3;
  const auto decoded = decode_import_request(encode_import_request(request).value());
  ASSERT_TRUE(decoded) << decoded.error().text();
  const auto* read = std::get_if<Rewrite>(&*decoded);
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(read->main, "main.k");
  EXPECT_EQ(read->content, request.content);
  EXPECT_EQ(read->limits.files, 3u);
  const auto answer = decode_from_import(encode_import_answer(Rewritten{{"no Landlock"}}, 1));
  ASSERT_TRUE(answer);
  EXPECT_EQ(std::get<Rewritten>(std::get<ImportAnswer>(answer->message)).unguarded.at(0), "no Landlock");
}

TEST(ImportMessages, that_cant_be_read_are_refused) {
  EXPECT_FALSE(decode_import_request(R"({"request":"rewrite","number":1,"main":"a.k"})")) << "of which content?";
  EXPECT_FALSE(decode_import_request(R"({"request":"import","number":1})")) << "no main file";
  EXPECT_NE(decode_import_request(R"({"request":"imprt","number":1})").error().message.find("import"), std::string::npos);
  EXPECT_FALSE(decode_import_request(R"({"request":"import","number":1,"main":"a","limits":{"cpu_s":-1}})"));
  EXPECT_FALSE(encode_import_request(Import{kImportProtocol, "\xff.k", "", {}})) << "a name that isn't UTF-8";
  EXPECT_FALSE(decode_from_import(R"({"answer":"opened","to":1})"));
}

}  // namespace
}  // namespace prismesh::ipc
