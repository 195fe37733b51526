// A sealed page of shared memory that one process writes and others read. Creates it with its layout, and checks it for readers. Each
// process of the writer makes a new page.
#pragma once

#include <cstdint>
#include <new>
#include <string>
#include <utility>

#include "base/error.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::ipc {

/// `Layout` begins with two words, magic and version, and has their values `kMagic` and `kVersion`, and a name for errors, `kName`.
template <class Layout>
class SealedPage {
 public:
  /// Allocates all memory, so that writing can't fail later. Errors: no memory.
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
  /// Errors: memory that could shrink or be written by another process, has another size, or holds something else.
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
