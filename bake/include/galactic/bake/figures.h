#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "galactic/bake/assets.h"

namespace galactic::bake {

// What tables and reports say about a finished pack: figures, not geometry. The cache keeps them
// beside the pack. Lengths are in meters, volumes in cubic meters, times in seconds of wall-clock
// time.

/// The results of simplifying and clustering one asset's meshes.
struct RenderFigures {
  /// One part: the scene, an object, or a link.
  struct Model {
    std::uint32_t part = 0;
    float step = 0;
    std::uint32_t source_triangles = 0;
    std::uint32_t triangles = 0;
    std::uint32_t clusters = 0;
    float largest_error = 0;
  };
  RenderBakeStatistics all{};
  std::uint64_t textures = 0;
  /// Hashes of the textures, if they are packs of their own.
  std::optional<std::vector<std::string>> shared_textures{};
  std::vector<Model> models{};
};

struct GridFigures {
  /// A connected part of the free space.
  struct Part {
    Region region = Region::kEnclosed;
    double volume = 0;
    Bounds bounds{};
  };
  float radius = 0;
  float spacing = 0;
  /// Number of columns along x and z.
  std::array<std::uint32_t, 2> columns{};
  std::uint64_t raw_spans = 0;
  std::uint64_t spans = 0;
  std::uint32_t max_spans_per_column = 0;
  std::uint64_t overflow_columns = 0;
  std::uint64_t merged_gaps = 0;
  std::uint64_t slivers = 0;
  std::uint64_t stored_bytes = 0;
  /// Indexed by Region.
  std::array<RegionTotals, kRegionCount> regions{};
  std::optional<CastCheck> cast_check{};
  /// Number of parts, and the largest of them by descending volume.
  std::uint64_t parts = 0;
  std::vector<Part> largest_parts{};
};

struct SceneFigures {
  std::string input{};
  ImportStatistics imported{};
  /// How axes and unit were interpreted, as text for people.
  std::string convention{};
  Bounds bounds{};
  StageTimes seconds{};
  std::vector<std::string> warnings{};
  std::optional<RenderFigures> render_meshes{};
  std::vector<GridFigures> grids{};
};

struct SphereFigures {
  std::uint64_t count = 0;
  /// By ascending radius.
  std::vector<std::uint64_t> count_per_radius{};
  SphereSetQuality quality{};
  double guaranteed_gap = 0;
  double guaranteed_protrusion = 0;
  bool meets_tolerances = true;
};

struct ObjectFigures {
  struct Times {
    double import = 0;
    ObjectTimes bake{};
  };
  std::string input{};
  std::string name{};
  ImportStatistics imported{};
  BoxFitResult box{};
  bool authored_spheres = false;
  SphereFigures spheres{};
  std::vector<StablePose> stable_poses{};
  Times seconds{};
  std::optional<RenderFigures> render_meshes{};
  std::vector<std::string> warnings{};
};

struct ObjectSetFigures {
  std::vector<float> radii{};
  std::vector<ObjectFigures> objects{};
  /// Warnings about the collection, and about meshes that are not objects.
  std::vector<std::string> warnings{};
  double seconds = 0;
};

struct RobotFigures {
  /// Links that move together.
  struct Group {
    std::string link{};
    std::vector<std::string> links{};
    bool by_hand = false;
    float eps = 0;
    float tau = 0;
    SphereFigures spheres{};
    /// Whether the group has geometry against which the spheres are measured.
    bool is_measured = false;
  };
  /// Two groups, by their links.
  struct Pair {
    std::string first{};
    std::string second{};
    PairKind kind = PairKind::kTested;
  };
  struct Times {
    double import = 0;
    RobotTimes bake{};
    double write = 0;
    double all = 0;
  };
  std::string input{};
  std::string name{};
  std::uint64_t links = 0;
  std::uint64_t joint_positions = 0;
  std::uint64_t controlled_joints = 0;
  std::vector<Group> groups{};
  std::vector<Pair> pairs{};
  /// Where each mesh was found, as text for people.
  std::vector<std::string> meshes{};
  Times seconds{};
  std::optional<RenderFigures> render_meshes{};
  std::vector<std::string> warnings{};
};

struct EpisodeFigures {
  /// From a target's start to its goal.
  struct Distances {
    double min = 0;
    double mean = 0;
    double max = 0;
  };
  std::string input{};
  std::string name{};
  std::string robot{};
  std::uint64_t episodes = 0;
  std::uint64_t placements = 0;
  std::uint64_t most_placements = 0;
  std::vector<std::string> scenes{};
  std::vector<std::string> objects{};
  std::vector<std::string> start_joints{};
  Distances target_to_goal{};
  double seconds = 0;
  std::vector<std::string> warnings{};
  std::optional<EpisodeGeneration> generation{};
};

struct WorldFigures {
  std::vector<LinkedPack> packs{};
  double seconds = 0;
};

/// The figures of one pack.
struct PackFigures {
  std::string output{};
  /// 0 where the pack was not written.
  std::uint64_t pack_bytes = 0;
  std::variant<SceneFigures, ObjectSetFigures, RobotFigures, EpisodeFigures, WorldFigures> of{};
};

[[nodiscard]] PackFigures figuresOf(const BakedPack& made);

/// What the user should examine, one sentence each.
[[nodiscard]] std::vector<std::string> warningsOf(const PackFigures& figures);

/// The hashes of the texture packs that the pack shares with others: HASH.pack in
/// DrawOptions::shared_textures.
[[nodiscard]] std::vector<std::string> sharedTexturesOf(const PackFigures& figures);

}  // namespace galactic::bake
