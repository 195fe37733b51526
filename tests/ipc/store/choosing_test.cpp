#include "ipc/store/choosing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::ipc::store {
namespace {

using ::testing::HasSubstr;

ModelRecord record_of(const std::string& text, const std::string& name) {
  ModelRecord record;
  record.model = sha256(text);
  record.name = name;
  return record;
}

TEST(ChooseModel, by_name_or_hash) {
  const std::vector<ModelRecord> models{record_of("a", "door"), record_of("b", "hood"), record_of("c", "hood")};
  EXPECT_EQ(choose_model(models, "door", "w", "l"), 0u);
  EXPECT_EQ(choose_model(models, sha256("b").hex(), "w", "l"), 1u);
  EXPECT_EQ(choose_model(models, sha256("c").hex().substr(0, 6), "w", "l"), 2u);
  EXPECT_THAT(choose_model(models, "hood", "w", "l").error().message, HasSubstr("has several models 'hood'"));
  EXPECT_THAT(choose_model(models, sha256("c").hex().substr(0, 5), "w", "l").error().message, HasSubstr("has no model"));
}

TEST(ChooseModel, a_name_never_stands_for_another_models_hash) {
  const std::string wanted = sha256("a").hex();
  const std::vector<ModelRecord> with_both{record_of("b", wanted), record_of("a", "door")};
  EXPECT_EQ(choose_model(with_both, wanted, "w", "l"), 1u);
  EXPECT_FALSE(choose_model({record_of("b", wanted)}, wanted, "w", "l"));
}

}  // namespace
}  // namespace prismesh::ipc::store
