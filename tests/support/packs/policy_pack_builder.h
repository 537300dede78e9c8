#pragma once
#include "galactic/pack_header.h"
#include "galactic/policy_pack.h"
#include "support/aligned_bytes.h"
#include "support/homes/policy_networks.h"

namespace galactic::test {

/// All that a policy pack holds, and the kind in its header.
struct PolicyPackFields {
  PackKind kind = PackKind::kPolicy;
  PolicyContent content = smallPolicy();
};

/// The whole file: header and payload.
AlignedBytes buildPack(const PolicyPackFields& fields);

}  // namespace galactic::test
