// Puts the regions in which shells touch into an answer.
#pragma once

#include <cstdint>

#include "ipc/model/messages.h"
#include "mesh/document/contacts.h"

namespace prismesh::modeld {

/// `limits`: what is beyond them is left out from the end.
ipc::Contacts contacts_answer(std::uint64_t generation, const mesh::document::Contacts& found,
                              const ipc::ContactLimits& limits = ipc::kMaxContacts);

}  // namespace prismesh::modeld
