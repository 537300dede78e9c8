#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "filled.h"
#include "galactic/ray_caster.h"
#include "options.h"
#include "simulator.h"

namespace galactic::python {
namespace {

CastRobot seen(bool robot) { return robot ? CastRobot::kIsSeen : CastRobot::kIsUnseen; }

std::unique_ptr<RayCaster> casterOfScene(const World& world, const py::object& scene) {
  const std::uint64_t last = world.scenes().size() - 1;
  return std::make_unique<RayCaster>(world.scenes()[wholeOf("scene", scene, 0, last)]);
}

std::unique_ptr<RayCaster> casterOfEnv(const py::object& given, const py::object& env, bool robot) {
  Simulator& simulator = simulatorOf(given);
  const Confinement::Use use = simulator.readState();
  return std::make_unique<RayCaster>(
      simulator.world(), simulator.batch().envState(simulator.envNumber(env)), seen(robot));
}

/// Lines as given by a caller.
struct GivenLines {
  const py::object& origins;
  const py::object& directions;
  const py::object& lengths;
};

/// Converted lines, and the shape of their results: (n,), or (envs, n).
class Lines {
 public:
  /// Lines for casts through one home.
  explicit Lines(const GivenLines& given)
      : origins_(pointsOf(given.origins, "origins")),
        directions_(directionsOf(given.directions, origins_.size())),
        shape_{static_cast<py::ssize_t>(origins_.size())} {
    readLengths(given.lengths);
  }
  /// Lines for casts through all envs of a batch.
  Lines(const GivenLines& given, py::ssize_t envs)
      : origins_(pointsOf(given.origins, "origins", envs)),
        directions_(pointsOf(given.directions, "directions", envs)),
        shape_{envs, static_cast<py::ssize_t>(origins_.size()) / envs} {
    readLengths(given.lengths);
  }

  [[nodiscard]] CastLines view() const { return {origins_, directions_, lengths_}; }

  /// The hits of the lines. `cast` fills them, without the interpreter's lock.
  template <class Cast>
  [[nodiscard]] py::object hitsOf(const Cast& cast) const {
    std::vector<CastHit> hits(origins_.size());
    {
      const py::gil_scoped_release unlocked;
      cast(view(), std::span(hits));
    }
    Filled<float> distances(shape_);
    Filled<std::uint8_t> ends(shape_);
    Filled<std::int32_t> indices(shape_);
    for (const CastHit& hit : hits) {
      distances.put(hit.distance);
      ends.put(static_cast<std::uint8_t>(hit.end));
      indices.put(hit.index);
    }
    return py::module_::import("galactic.cast_hits")
        .attr("CastHits")(distances.array(), ends.array(), indices.array());
  }

 private:
  /// One direction for all lines, or one for each.
  static std::vector<Vec3> directionsOf(const py::object& given, std::size_t count) {
    const py::array array = numbersIn(given, "directions");
    if (array.ndim() != 1 || array.size() == 0) return pointsOf(given, "directions");
    const std::vector<float> one = finiteNumbers(array, "directions", 3);
    return std::vector<Vec3>(count, Vec3{one[0], one[1], one[2]});
  }
  /// One length for all lines, or one for each.
  void readLengths(const py::object& given) {
    const py::array array = numbersIn(given, "lengths");
    if (array.ndim() == 0) {
      lengths_.assign(origins_.size(), *inputOf<float>(array, "lengths", {}).data());
    } else {
      const auto lengths = inputOf<float>(array, "lengths", shape_);
      lengths_.assign(lengths.data(), lengths.data() + lengths.size());
    }
  }

  std::vector<Vec3> origins_;
  std::vector<Vec3> directions_;
  std::vector<float> lengths_;
  Shape shape_;
};

py::object castRays(const RayCaster& caster, const py::object& origins,
                    const py::object& directions, const py::object& lengths,
                    const py::object& threads) {
  const std::uint32_t count = threadsOf(threads);
  return Lines({origins, directions, lengths})
      .hitsOf([&](const CastLines& lines, std::span<CastHit> hits) {
        caster.castRays(lines, hits, count);
      });
}

py::object sweepSpheres(const RayCaster& caster, float radius, const py::object& origins,
                        const py::object& directions, const py::object& lengths,
                        const py::object& threads) {
  const std::uint32_t count = threadsOf(threads);
  return Lines({origins, directions, lengths})
      .hitsOf([&](const CastLines& lines, std::span<CastHit> hits) {
        caster.sweepSpheres(radius, lines, hits, count);
      });
}

py::array_t<bool> spheresFree(const RayCaster& caster, float radius, const py::object& centers,
                              const py::object& threads) {
  const std::uint32_t count = threadsOf(threads);
  const std::vector<Vec3> points = pointsOf(centers, "centers");
  std::vector<std::uint8_t> free(points.size());
  {
    const py::gil_scoped_release unlocked;
    caster.areSpheresFree(radius, points, free, count);
  }
  return truthsOf(free);
}

py::object castRaysInAll(Simulator& simulator, const py::object& origins,
                         const py::object& directions, const py::object& lengths, bool robot,
                         const py::object& threads) {
  const std::uint32_t count = threadsOf(threads);
  const Confinement::Use use = simulator.readState();
  return Lines({origins, directions, lengths}, simulator.envs())
      .hitsOf([&](const CastLines& lines, std::span<CastHit> hits) {
        castRaysInEnvs(simulator.batch(), lines, hits, seen(robot), count);
      });
}

py::object sweepSpheresInAll(Simulator& simulator, float radius, const py::object& origins,
                             const py::object& directions, const py::object& lengths, bool robot,
                             const py::object& threads) {
  const std::uint32_t count = threadsOf(threads);
  const Confinement::Use use = simulator.readState();
  return Lines({origins, directions, lengths}, simulator.envs())
      .hitsOf([&](const CastLines& lines, std::span<CastHit> hits) {
        sweepSpheresInEnvs(simulator.batch(), radius, lines, hits, seen(robot), count);
      });
}

}  // namespace

void bindRayCaster(py::module_& module) {
  bindEnum(module, "CastEnd",
           {{"NOTHING", static_cast<int>(CastEnd::kNothing)},
            {"SCENE", static_cast<int>(CastEnd::kScene)},
            {"OBJECT", static_cast<int>(CastEnd::kObject)},
            {"ROBOT", static_cast<int>(CastEnd::kRobot)},
            {"OUTSIDE", static_cast<int>(CastEnd::kOutside)}},
           "What a ray or a sphere hits: nothing, the static scene, an object, the robot, or\n"
           "the boundary of the column grid, beyond which nothing is known.");
  const py::object infinity = py::float_(std::numeric_limits<double>::infinity());
  py::class_<RayCaster> type(module, "RayCaster");
  type.def(py::init(&casterOfScene), py::arg("world"), py::arg("scene"), py::keep_alive<1, 2>(),
           "A caster for the static scene alone; of_env() includes objects. scene: index into\n"
           "World.scenes.")
      .def_static("of_env", &casterOfEnv, py::arg("simulator"), py::arg("env") = 0, py::kw_only(),
                  py::arg("robot").noconvert() = false,
                  "A caster for an env in its current state: with its objects and, with\n"
                  "robot=True, the robot and what it holds. Make another one after a step.")
      .def("cast_rays", &castRays, py::arg("origins"), py::arg("directions"),
           py::arg("lengths") = infinity, py::kw_only(), py::arg("threads") = 1,
           "How far rays get from origins, (n, 3), in directions, (n, 3) or (3,) for all, of\n"
           "any length except zero: CastHits.\n\n"
           "lengths: how far to go at most, meters, for all or (n,). Rays hit objects' boxes\n"
           "and the robot's spheres on their surfaces, and the scene where a sphere of the\n"
           "smallest radius would touch it, by the column grid of that radius. threads: 0 for\n"
           "all.")
      .def("sweep_spheres", &sweepSpheres, py::arg("radius"), py::arg("origins"),
           py::arg("directions"), py::arg("lengths") = infinity, py::kw_only(),
           py::arg("threads") = 1,
           "How far spheres get before they touch something: CastHits, as from cast_rays().\n\n"
           "radius: one of World.radii. origins: where their centers begin.")
      .def("spheres_free", &spheresFree, py::arg("radius"), py::arg("centers"), py::kw_only(),
           py::arg("threads") = 1,
           "Whether spheres touch nothing where they are: bool (n,), as sweep_spheres() finds\n"
           "with length 0. Also False outside the column grid.\n\n"
           "radius: one of World.radii. centers: (n, 3), world frame, meters. threads: 0 for\n"
           "all.")
      .def_static("cast_rays_in_envs", &castRaysInAll, py::arg("simulator"), py::arg("origins"),
                  py::arg("directions"), py::arg("lengths") = infinity, py::kw_only(),
                  py::arg("robot").noconvert() = false, py::arg("threads") = 1,
                  "How far rays get in all envs of a simulator in their current state, from\n"
                  "origins, (num_envs, n, 3), in directions, (num_envs, n, 3): CastHits of\n"
                  "shape (num_envs, n), as from of_env(simulator, env,\n"
                  "robot=robot).cast_rays().\n\n"
                  "lengths: for all or (num_envs, n). threads share the envs; 0 for all.")
      .def_static("sweep_spheres_in_envs", &sweepSpheresInAll, py::arg("simulator"),
                  py::arg("radius"), py::arg("origins"), py::arg("directions"),
                  py::arg("lengths") = infinity, py::kw_only(),
                  py::arg("robot").noconvert() = false, py::arg("threads") = 1,
                  "How far spheres get in all envs: sweep_spheres() for all envs, like\n"
                  "cast_rays_in_envs().");
  type.doc() =
      "Casts rays and sweeps spheres through a home as the simulation models it. A caster never\n"
      "changes.";
  type.attr("__module__") = "galactic";
  refusePickling(type, "make one from its world or simulator");
}

}  // namespace galactic::python
