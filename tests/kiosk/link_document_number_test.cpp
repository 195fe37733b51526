#include "kiosk/link/document_number.h"

#include <gtest/gtest.h>

namespace prismesh::kiosk::link {
namespace {

TEST(DocumentNumberTest, counts_documents_and_not_names_of_the_same_one) {
  DocumentNumber number;
  EXPECT_EQ(number.value(), 0u);
  number.follow("a.k");
  number.follow("a.k");
  EXPECT_EQ(number.value(), 1u);
  number.becomes("b.k");
  number.follow("b.k");  // the server tells it before it answers the saving
  number.becomes({});
  number.rename("b.k");
  number.follow("b.k");
  EXPECT_EQ(number.value(), 1u) << "it was saved under another name";
  number.follow("a.k");
  EXPECT_EQ(number.value(), 2u);
  number.close();
  EXPECT_EQ(number.path(), "");
  number.follow("a.k");
  EXPECT_EQ(number.value(), 3u) << "it was closed in between";
}

}  // namespace
}  // namespace prismesh::kiosk::link
