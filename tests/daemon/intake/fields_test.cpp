#include "daemon/intake/http/fields.h"

#include <gtest/gtest.h>

#include "daemon/intake/api/pair_request.h"
#include "daemon/intake/http/routes.h"

namespace prismesh::intake {
namespace {

TEST(HeaderFields, sizes_are_digits_only) {
  EXPECT_EQ(parse_size("0"), 0u);
  EXPECT_EQ(parse_size("9223372036854775807"), 9223372036854775807u);
  for (const char* bad : {"", "-1", "+1", " 1", "1 ", "0x1", "1.0", "9223372036854775808", "1,1"}) EXPECT_FALSE(parse_size(bad)) << bad;
}

TEST(HeaderFields, metadata_of_uploads) {
  EXPECT_EQ(parse_upload_metadata("filename YS5r,is_last"), (std::map<std::string, std::string>{{"filename", "a.k"}, {"is_last", ""}}));
  EXPECT_EQ(parse_upload_metadata("a YQ==, b Yg=="), (std::map<std::string, std::string>{{"a", "a"}, {"b", "b"}}));
  EXPECT_EQ(parse_upload_metadata(""), (std::map<std::string, std::string>{}));
  for (const char* bad : {",", "a YQ==,", "a YQ==,,b", "a YQ", "a *", "a YQ==,a YQ==", "a  YQ==", "\xff YQ=="})
    EXPECT_FALSE(parse_upload_metadata(bad)) << bad;
  std::string many;
  for (int i = 0; i < 33; ++i) many += (i > 0 ? ",k" : "k") + std::to_string(i);
  EXPECT_FALSE(parse_upload_metadata(many));
}

TEST(HeaderFields, ranges_of_a_file_of_ten_bytes) {
  EXPECT_EQ(parse_range("bytes=0-9", 10), (ByteRange{0, 10}));
  EXPECT_EQ(parse_range("bytes=0-99", 10), (ByteRange{0, 10}));
  EXPECT_EQ(parse_range("bytes=9-9", 10), (ByteRange{9, 1}));
  EXPECT_EQ(parse_range("bytes=4-", 10), (ByteRange{4, 6}));
  EXPECT_EQ(parse_range("bytes=-4", 10), (ByteRange{6, 4}));
  EXPECT_EQ(parse_range("bytes=-40", 10), (ByteRange{0, 10}));
  EXPECT_EQ(parse_range("bytes=0-9223372036854775807", 10), (ByteRange{0, 10}));
  for (const char* behind : {"bytes=10-", "bytes=10-11", "bytes=-0"})
    EXPECT_EQ(parse_range(behind, 10).error(), RangeFault::unsatisfiable) << behind;
  for (const char* other : {"", "bytes", "bytes=", "bytes=-", "bytes=a-b", "bytes=5-4", "bytes=0-1,3-4", "lines=0-1",
                            "bytes=99999999999999999999-", "bytes=--5"})
    EXPECT_EQ(parse_range(other, 10).error(), RangeFault::none_asked) << other;
  EXPECT_EQ(parse_range("bytes=0-", 0).error(), RangeFault::unsatisfiable);
}

TEST(HeaderFields, tags_in_lists) {
  EXPECT_TRUE(lists_tag("\"a\"", "\"a\""));
  EXPECT_TRUE(lists_tag("\"b\", W/\"a\"", "\"a\""));
  EXPECT_TRUE(lists_tag("*", "\"a\""));
  EXPECT_FALSE(lists_tag("a", "\"a\""));
  EXPECT_FALSE(lists_tag("", "\"a\""));
}

TEST(HeaderFields, tokens) {
  EXPECT_EQ(parse_bearer("Bearer pm_0aZ-."), "pm_0aZ-.");
  for (const char* bad : {"", "Bearer", "Bearer ", "bearer a", "Basic a", "Bearer a b", "Bearer a,b", "Bearer  a"})
    EXPECT_FALSE(parse_bearer(bad)) << bad;
  EXPECT_FALSE(parse_bearer("Bearer " + std::string(201, 'a')));
}

TEST(HeaderFields, cookies) {
  EXPECT_EQ(parse_session_cookie("__Host-prismesh=pm_0aZ"), "pm_0aZ");
  EXPECT_EQ(parse_session_cookie("a=b; __Host-prismesh=pm_0aZ;c"), "pm_0aZ");
  for (const char* bad : {"", "__Host-prismesh", "__Host-prismesh=", "__Host-prismesh=a b", "__Host-prismesh=\"a\"", "prismesh=a",
                          "__host-prismesh=a", "x__Host-prismesh=a", "a=__Host-prismesh=a", "__Host-prismesh=a; __Host-prismesh=a"})
    EXPECT_FALSE(parse_session_cookie(bad)) << bad;
  EXPECT_EQ(session_cookie("pm_0", 60), "__Host-prismesh=pm_0; Path=/; Max-Age=60; Secure; HttpOnly; SameSite=Strict");
  EXPECT_EQ(session_cookie("", 60), "__Host-prismesh=; Path=/; Max-Age=0; Secure; HttpOnly; SameSite=Strict");
}

TEST(HeaderFields, targets) {
  const auto target = parse_target("/models?name=a%20b+c&count=5&flag");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/models");
  EXPECT_EQ(target->query, (std::map<std::string, std::string, std::less<>>{{"name", "a b c"}, {"count", "5"}, {"flag", ""}}));
  for (const char* bad :
       {"", "models", "//evil.example/", "/a b", "/a#b", "/a\\b", "/a?x=%", "/a?x=%2", "/a?x=%zz", "/a?x=1&x=2", "/\x80", "*"})
    EXPECT_FALSE(parse_target(bad)) << bad;
}

TEST(HeaderFields, hosts) {
  EXPECT_EQ(parse_host("Station.Example:7443"), "station.example");
  EXPECT_EQ(parse_host("127.0.0.1"), "127.0.0.1");
  EXPECT_EQ(parse_host("[::1]:7443"), "::1");
  for (const char* bad : {"", ":1", "a:", "a:b", "a:65536", "a:1:2", "[::1", "[a]", "a/b", "a@b", "a b", "[::1]x"})
    EXPECT_FALSE(parse_host(bad)) << bad;
  EXPECT_TRUE(is_address_literal("10.0.0.1"));
  EXPECT_TRUE(is_address_literal("fe80::1"));
  EXPECT_FALSE(is_address_literal("10.0.0.1.example"));
}

TEST(RouteTable, finds_routes_by_whole_paths) {
  EXPECT_EQ(find_route("GET", "/models/abc/files/def").route->operation, Operation::fetch_file);
  EXPECT_EQ(find_route("GET", "/models/abc/files/def").parts, (std::vector<std::string_view>{"abc", "def"}));
  EXPECT_EQ(find_route("HEAD", "/models").route->operation, Operation::list_models);
  EXPECT_EQ(find_route("PUT", "/models").route, nullptr);
  EXPECT_EQ(find_route("PUT", "/models").allowed, "GET, HEAD, POST");
  for (const char* none : {"", "/page", "/page/", "/model", "/modelsx", "/models/", "/models//files/x", "/models/a/files/",
                           "/models/a/files/b/c", "/uploads/"})
    EXPECT_TRUE(find_route("GET", none).allowed.empty()) << none;
}

TEST(PairRequestBody, is_json_with_a_secret) {
  const Result<PairRequest> read = parse_pair_request(R"({"secret": "ABCD", "name": "ann", "more": 1})");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->secret, "ABCD");
  EXPECT_EQ(read->name, "ann");
  for (const char* bad : {"", "{", "[]", "5", R"({"name": "ann"})", R"({"secret": 5})"}) EXPECT_FALSE(parse_pair_request(bad)) << bad;
}

}  // namespace
}  // namespace prismesh::intake
