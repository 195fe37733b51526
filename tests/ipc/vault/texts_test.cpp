#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/vault/address.h"
#include "ipc/vault/objects.h"
#include "ipc/vault/s3_answers.h"
#include "ipc/vault/s3_line.h"
#include "ipc/vault/settings.h"

namespace prismesh::ipc::vault {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(VaultAddress, is_read_as_it_is_written) {
  for (const char* text : {"s3+https://store.example.com/crash", "s3+https://store.example.com:8443/crash/a/b",
                           "s3+http://127.0.0.1:8080/c_1.x-y", "s3+http://[::1]:8080/crash", "s3+http://[fe80::1]/crash"}) {
    const Result<VaultAddress> address = parse_vault_address(text);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(address->text(), text);
  }
  const Result<VaultAddress> address = parse_vault_address("s3+https://h:1/b/x/y/");
  ASSERT_TRUE(address);
  EXPECT_EQ(*address, (VaultAddress{false, "h", 1, "b", "x/y/"}));
  EXPECT_EQ(address->origin(), "https://h:1");
}

TEST(VaultAddress, refuses_others) {
  for (const char* text : {"", "s3://h/b", "https://h/b", "s3+https://h", "s3+https://h/", "s3+https:///b", "s3+https://h:0/b",
                           "s3+https://h:x/b", "s3+https://h/..", "s3+https://h/b/../c", "s3+https://h/b//c", "s3+https://h/b c",
                           "s3+https://h/b?c", "s3+https://h/b/#", "s3+https://-h/b", "S3+https://h/b", "s3+https://h/b//"}) {
    const Result<VaultAddress> address = parse_vault_address(text);
    ASSERT_FALSE(address) << text;
    EXPECT_THAT(address.error().message, HasSubstr("s3+https://HOST/BUCKET")) << text;
  }
  for (const char* text : {"s3+https://me:hidden@h/b", "https://me:hidden@h/b", "s3://me:hidden@h/b", "me:hidden@h/b"}) {
    const Result<VaultAddress> secret = parse_vault_address(text);
    ASSERT_FALSE(secret) << text;
    EXPECT_THAT(secret.error().text(), HasSubstr("has no credentials in it"));
    EXPECT_THAT(secret.error().text(), Not(HasSubstr("hidden")));
  }
}

TEST(VaultAddress, knows_this_computer) {
  for (const char* host : {"localhost", "127.0.0.1", "127.9.9.9", "[::1]"})
    EXPECT_TRUE(parse_vault_address(std::string("s3+http://") + host + "/b")->is_loopback()) << host;
  for (const char* host : {"127.0.0.1.example.com", "127.evil", "localhost.example.com", "128.0.0.1", "[::2]"})
    EXPECT_FALSE(parse_vault_address(std::string("s3+http://") + host + "/b")->is_loopback()) << host;
}

TEST(VaultSettings, are_read_and_never_shown) {
  const Result<VaultSettings> all =
      parse_vault_settings("vault = \"s3+https://h/b\"\nregion = 'x'\naccess_key_id = 'a:b'\nsecret_access_key = 'c'\n", "f");
  ASSERT_TRUE(all);
  EXPECT_EQ(all->vault, "s3+https://h/b");
  EXPECT_EQ(all->region + " " + all->access_key_id + " " + all->secret_access_key, "x a:b c");
  for (const char* text : {"secret_access_key = hidden", "secret_access_key = 'hidden value'", "secret_access_key = ['hidden']",
                           "secret_access_key = \"hidden", "'hidden' = 1", "secret_access_key = \"hidden\\u00e9\""}) {
    const Result<VaultSettings> refused = parse_vault_settings(text, "f");
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().line, 1) << text;
    EXPECT_THAT(refused.error().text(), Not(HasSubstr("hidden")));
  }
}

TEST(VaultObjects, have_names_that_are_read_again) {
  store::ModelRecord record;
  record.model = store::sha256("m");
  record.name = "Vorderwagen é / 7";
  record.when_s = 1'795'000'000;
  record.bytes = 12;
  record.files = 3;
  EXPECT_EQ(record_of_object(name_object(record)), record);
  const std::string object = name_object(record);
  record.name = std::string(200, 'x');
  const std::string long_object = name_object(record);
  EXPECT_EQ(record_of_object(long_object), record);
  for (std::size_t at = 0; at < long_object.size();) {
    const std::size_t end = std::min(long_object.find('/', at), long_object.size());
    EXPECT_LE(end - at, 255u);
    at = end + 1;
  }
  std::string unsplit = long_object;
  unsplit.erase(unsplit.rfind('/'), 1);
  EXPECT_FALSE(record_of_object(unsplit));
  for (const char* name : {"abcdef", "20261128", "", "a\nb"}) {
    store::ModelRecord other = record;
    other.name = name;
    EXPECT_FALSE(record_of_object(name_object(other))) << name;
  }
  EXPECT_EQ(object.find_first_not_of("0123456789abcdefnms/-"), std::string::npos);
  for (const std::string& other :
       std::vector<std::string>{object + "0", object.substr(1), object + "zz", object + "1b", "names/" + record.model.hex(),
                                "names/" + record.model.hex() + "/1-2-3-", "names/" + record.model.hex() + "/01-2-3-61",
                                "names/" + record.model.hex() + "/1-2-61", "models/" + record.model.hex()})
    EXPECT_FALSE(record_of_object(other)) << other;
  EXPECT_EQ(model_of_object(model_object(record.model)), record.model);
  EXPECT_FALSE(model_of_object("models/x"));
  EXPECT_FALSE(model_of_object(piece_object(record.model)));
}

TEST(VaultObjects, list_as_many_pieces_as_a_file_has) {
  EXPECT_EQ(piece_count(0), 0u);
  EXPECT_EQ(piece_count(1), 1u);
  EXPECT_EQ(piece_count(kPieceBytes), 1u);
  EXPECT_EQ(piece_count(kPieceBytes + 1), 2u);
  const std::vector<store::ContentHash> pieces{store::sha256("a"), store::sha256("b")};
  const std::string text = encode_pieces(pieces);
  const Result<std::vector<store::ContentHash>> read = decode_pieces(text, 2 * kPieceBytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, pieces);
  EXPECT_FALSE(decode_pieces(text, 2 * kPieceBytes + 1));
  EXPECT_FALSE(decode_pieces(text, kPieceBytes));
  EXPECT_FALSE(decode_pieces(text + "x", 2 * kPieceBytes));
  EXPECT_FALSE(decode_pieces("prismesh-pieces 2\n" + text.substr(18), 2 * kPieceBytes));
  std::string other = text;
  other[20] = 'X';
  EXPECT_FALSE(decode_pieces(other, 2 * kPieceBytes));
}

// As Amazon's documentation shows it: ListObjectsV2, "Sample Response for a continuation token".
TEST(S3Answers, list_objects) {
  const Result<ObjectList> list = parse_object_list(R"(<?xml version="1.0" encoding="UTF-8"?>
<ListBucketResult xmlns="http://s3.amazonaws.com/doc/2006-03-01/">
  <Name>quotes</Name><Prefix>N</Prefix><KeyCount>2</KeyCount><MaxKeys>3</MaxKeys><IsTruncated>true</IsTruncated>
  <NextContinuationToken>1ueGcxLPRx1Tr/XYExHnhbYLgveDs2J/wm36Hy4vbOwM=</NextContinuationToken>
  <Contents><Key>Nelson &amp; sons</Key><LastModified>2014-11-21T19:40:05.000Z</LastModified><Size>28724</Size></Contents>
  <Contents><Key>N<![CDATA[<2>]]></Key><Size>0</Size></Contents>
</ListBucketResult>)");
  ASSERT_TRUE(list) << list.error().text();
  ASSERT_EQ(list->objects.size(), 2u);
  EXPECT_EQ(list->objects[0].key, "Nelson & sons");
  EXPECT_EQ(list->objects[0].bytes, 28724u);
  EXPECT_EQ(list->next, "1ueGcxLPRx1Tr/XYExHnhbYLgveDs2J/wm36Hy4vbOwM=");
}

TEST(S3Answers, refuse_what_is_no_list) {
  const std::string whole = "<ListBucketResult><IsTruncated>false</IsTruncated></ListBucketResult>";
  EXPECT_TRUE(parse_object_list(whole));
  for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_FALSE(parse_object_list(whole.substr(0, size))) << size;
  for (const char* text :
       {"<html/>", "<ListBucketResult/>", "<ListBucketResult><IsTruncated>true</IsTruncated></ListBucketResult>",
        "<ListBucketResult><IsTruncated>false</IsTruncated><Contents><Key>a</Key><Size>-1</Size></Contents></ListBucketResult>",
        "<ListBucketResult><IsTruncated>false</IsTruncated><Contents><Key>a</Key><Size>99999999999999999999</Size></Contents></"
        "ListBucketResult>",
        "<ListBucketResult><IsTruncated>false</IsTruncated><Contents><Size>1</Size></Contents></ListBucketResult>"})
    EXPECT_FALSE(parse_object_list(text)) << text;
  const auto going_on = [](std::size_t size) {
    return parse_object_list("<ListBucketResult><IsTruncated>true</IsTruncated><NextContinuationToken>" + std::string(size, 'a') +
                             "</NextContinuationToken></ListBucketResult>");
  };
  EXPECT_TRUE(going_on(4096));
  EXPECT_THAT(going_on(4097).error().message, HasSubstr("in more than 4096 bytes where its list goes on"));
}

TEST(S3Line, a_request_that_cannot_be_made_is_a_fault) {
  S3Line line({true, "127.0.0.1", 1, "b", ""}, {std::nullopt, "r", "k", "hidden", ""}, {}, {});
  std::string none;
  const LineResult<S3Answer> answer = line.ask({S3Request::Method::get, "", "a=" + std::string(9'000'000, 'a'), {}}, none, 0);
  ASSERT_FALSE(answer);
  EXPECT_FALSE(answer.error().may_pass);
  EXPECT_THAT(answer.error().error.text(), HasSubstr("the request failed"));
}

TEST(S3Answers, tell_refusals_that_can_be_shown) {
  const S3Refusal refusal =
      parse_refusal("<?xml version='1.0'?><Error><Code>NoSuchBucket</Code><Message>It isn't &lt;there&gt;</Message></Error>");
  EXPECT_EQ(refusal.code + "|" + refusal.message, "NoSuchBucket|It isn't <there>");
  EXPECT_EQ(parse_refusal("<Error><Code>a&#27;[2J</Code></Error>").code, "");
  EXPECT_EQ(parse_refusal("<Error><Code>A</Code><Message>" + std::string(2000, 'x') + "</Message></Error>").message, "");
  // An entity of the document's own stays as it is written.
  EXPECT_EQ(parse_refusal("<!DOCTYPE x [<!ENTITY e \"evil\">]><Error><Code>A</Code><Message>&e;</Message></Error>").message, "&e;");
  EXPECT_EQ(parse_refusal("no XML").code, "");
}

}  // namespace
}  // namespace prismesh::ipc::vault
