#include "mesh/quality/shell_batch.h"

#include "mesh/quality/shell_kernels.h"

// The kernels are compiled once more for AVX2 and chosen when the program is loaded. Both give the same bits: the operations
// are the same IEEE ones, none is contracted or reordered. Sanitizers can't follow that choice at load time.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(PRISMESH_ADDRESS_SANITIZER) && \
    !defined(PRISMESH_THREAD_SANITIZER)
#define PRISMESH_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define PRISMESH_CLONES
#endif

namespace prismesh::mesh::quality {

PRISMESH_CLONES void measure_quads(const ShellBatch& batch, BatchValues& values) { kernels::quads(batch, values); }
PRISMESH_CLONES void measure_triangles(const ShellBatch& batch, BatchValues& values) { kernels::triangles(batch, values); }
PRISMESH_CLONES void extend_quads(const ShellBatch& batch, int shell_option, BatchExtents& extents) {
  kernels::extents<false>(batch, shell_option, extents);
}
PRISMESH_CLONES void extend_triangles(const ShellBatch& batch, int shell_option, BatchExtents& extents) {
  kernels::extents<true>(batch, shell_option, extents);
}

}  // namespace prismesh::mesh::quality
