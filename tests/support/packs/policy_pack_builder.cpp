#include "support/packs/policy_pack_builder.h"

#include "support/packs/pack_parts.h"

namespace galactic::test {

AlignedBytes buildPack(const PolicyPackFields& fields) {
  const std::vector<std::byte> file = encodePolicyPack(fields.content, smallPolicyProvenance());
  return packFile(fields.kind, std::span(file).subspan(sizeof(PackHeader)));
}

}  // namespace galactic::test
