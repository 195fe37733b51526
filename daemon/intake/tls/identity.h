// The station's key and certificate, made on the first start. Clients know the certificate by its fingerprint; no authority vouches for it.
#pragma once

#include <string>

#include "base/error.h"
#include "ipc/store/folder.h"
#include "ipc/store/sha256.h"

namespace prismesh::intake {

struct Identity {
  std::string pem;                      ///< key and certificate
  ipc::store::ContentHash fingerprint;  ///< SHA-256 of the certificate (DER)
};

/// Reads `identity.pem`, or makes it (owner only). Errors: it is damaged (it isn't replaced: clients would take that for an attack), others
/// may read it, the disk.
Result<Identity> open_identity(const ipc::store::Folder& folder);

}  // namespace prismesh::intake
