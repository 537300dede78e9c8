// What a learned policy takes: processor time per env of act(), on one thread, for the networks of
// the paper and those that learn on processors. The images are noise.
//
//   learned_policy [--benchmark_filter=state]
#include "galactic/learned_policy.h"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "support/aligned_bytes.h"
#include "support/homes/policy_networks.h"

namespace {

using namespace galactic;

/// A network and all that it is given.
struct Bench {
  Bench(const std::string& name, std::size_t envs) {
    const PolicyContent content = test::policyNetwork(name);
    const test::AlignedBytes file(encodePolicyPack(content, test::smallPolicyProvenance()));
    const auto pack = PackFile::view(file.bytes(), name, Trust::kTrusted);
    PolicyBatch batch{
        .envs = envs, .actions = 11, .observation_size = 0, .observation = {}, .robot = {}};
    for (const PolicyPart& part : content.interface.observation) {
      batch.observation.push_back({part.name, batch.observation_size, part.size});
      batch.observation_size += part.size;
    }
    auto made = LearnedPolicy::create(*pack, batch, {.threads = 1});
    if (!made) {
      std::fprintf(stderr, "%s\n", made.error().message.c_str());
      std::exit(1);
    }
    policy.emplace(std::move(*made));
    test::WeightStream numbers(3);
    observations = numbers.take(envs * batch.observation_size, 2);
    actions.resize(envs * batch.actions);
    dones.resize(envs);
    const std::optional<PolicyImage>& image = content.interface.image;
    if (!image) return;
    const std::size_t pixels = envs * image->width * image->height;
    depth.resize(pixels, 3);
    if (!image->color) return;
    color.resize(pixels * 4);
    for (std::size_t n = 0; n < color.size(); ++n) {
      color[n] = static_cast<std::uint8_t>(n * 2654435761U >> 24U);
    }
  }

  void act() { policy->act({observations, dones, color, depth}, actions); }

  std::optional<LearnedPolicy> policy;
  std::vector<float> observations;
  std::vector<std::uint8_t> dones;
  std::vector<std::uint8_t> color;
  std::vector<float> depth;
  std::vector<float> actions;
};

void act(benchmark::State& state, const std::string& name) {
  const auto envs = static_cast<std::size_t>(state.range(0));
  Bench bench(name, envs);
  for (auto step : state) bench.act();
  const auto decided = static_cast<double>(state.iterations()) * static_cast<double>(envs);
  state.counters["envs/s"] = benchmark::Counter(decided, benchmark::Counter::kIsRate);
  state.counters["us/env"] =
      benchmark::Counter(decided * 1e-6, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(act, state, "state")->Arg(1024)->Arg(1);
BENCHMARK_CAPTURE(act, state_gru, "state_gru")->Arg(1024)->Arg(1);
BENCHMARK_CAPTURE(act, depth_gru, "depth_gru")->Arg(64)->Arg(1);
BENCHMARK_CAPTURE(act, simple_cnn, "simple_cnn")->Arg(64)->Arg(1);
BENCHMARK_CAPTURE(act, resnet9, "resnet9")->Arg(64)->Arg(1);
BENCHMARK_CAPTURE(act, resnet18, "resnet18")->Arg(64)->Arg(1);

}  // namespace

BENCHMARK_MAIN();
