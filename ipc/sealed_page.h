// A page of shared memory that one process writes and others look at: made, filled with its layout and sealed in one place, and
// checked by its readers in one place. A page belongs to one life of its writer.
#pragma once

#include <cstdint>
#include <new>
#include <string>
#include <utility>

#include "base/error.h"
#include "ipc/descriptor.h"

namespace prismesh::ipc {

/// `Layout` begins with two words, magic and version, and says what they must be: `kName` (for people), `kMagic`, `kVersion`.
template <class Layout>
class SealedPage {
 public:
  /// Errors: no memory. All of it is there afterwards, so that writing it can't fail.
  static Result<SealedPage> create() {
    Result<Descriptor> memory = make_shared_memory(Layout::kName, sizeof(Layout));
    if (!memory) return fail(std::move(memory.error()));
    if (Result<void> reserved = reserve(*memory, 0, sizeof(Layout)); !reserved) return fail(std::move(reserved.error()));
    Result<Mapping> mapping = Mapping::map(*memory, true);
    if (!mapping) return fail(std::move(mapping.error()));
    if (Result<void> sealed = seal_for_readers(*memory); !sealed) return fail(std::move(sealed.error()));
    SealedPage page;
    page.descriptor_ = std::move(*memory);
    page.mapping_ = std::move(*mapping);
    page.layout_ = new (page.mapping_.writable_bytes().data()) Layout;
    page.layout_->magic = Layout::kMagic;
    page.layout_->version = Layout::kVersion;
    return page;
  }

  Layout* operator->() { return layout_; }
  const Descriptor& descriptor() const { return descriptor_; }

 private:
  Descriptor descriptor_;
  Mapping mapping_;
  Layout* layout_ = nullptr;
};

template <class Layout>
class SealedPageReader {
 public:
  /// Errors: memory that could shrink or be written by somebody else, of another size, or that holds something else.
  static Result<SealedPageReader> map(const Descriptor& descriptor) {
    if (Result<void> sealed = check_page_seals(descriptor, Layout::kName); !sealed) return fail(std::move(sealed.error()));
    Result<Mapping> mapping = Mapping::map(descriptor, false);
    if (!mapping) return fail(std::move(mapping.error()));
    if (mapping->bytes().size() != sizeof(Layout))
      return fail(Layout::kName, "it has another size: use programs of one version, and restart the daemon after an update");
    SealedPageReader reader;
    reader.mapping_ = std::move(*mapping);
    reader.layout_ = reinterpret_cast<const Layout*>(reader.mapping_.bytes().data());
    if (reader.layout_->magic != Layout::kMagic || reader.layout_->version != Layout::kVersion)
      return fail(Layout::kName, "it is none, or of another version");
    return reader;
  }

  const Layout* operator->() const { return layout_; }

 private:
  Mapping mapping_;
  const Layout* layout_ = nullptr;
};

}  // namespace prismesh::ipc
