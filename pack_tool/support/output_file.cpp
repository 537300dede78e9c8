#include "pack_tool/support/output_file.h"

#include "support/files/atomic_file.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic::pack_tool {

Result<void> checkOutput(const PackFile& pack, const std::filesystem::path& output) {
  if (!isSameFile(pack.where(), output)) return {};
  return fail(ErrorCode::kInvalidInput, output.string(),
              "is the pack itself; write to another file");
}

Result<void> writeOutput(const std::filesystem::path& output, const std::string& bytes) {
  RETURN_IF_ERROR(tryFile(output));
  return writeFileAtomically(output, bytes);
}

}  // namespace galactic::pack_tool
