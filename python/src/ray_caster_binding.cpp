#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "filled.h"
#include "galactic/ray_caster.h"
#include "options.h"
#include "simulator.h"

namespace galactic::python {
namespace {

std::unique_ptr<RayCaster> casterOfScene(const World& world, const py::object& scene) {
  const std::uint64_t last = world.scenes().size() - 1;
  return std::make_unique<RayCaster>(world.scenes()[wholeOf("scene", scene, 0, last)]);
}

std::unique_ptr<RayCaster> casterOfEnv(const py::object& given, const py::object& env, bool robot) {
  Simulator& simulator = simulatorOf(given);
  const Confinement::Use use = simulator.readState();
  return std::make_unique<RayCaster>(simulator.world(),
                                     simulator.batch().envState(simulator.envNumber(env)),
                                     robot ? CastRobot::kIsSeen : CastRobot::kIsUnseen);
}

/// One length for all lines, or one for each.
std::vector<float> lengthsOf(const py::object& given, std::size_t count) {
  const py::array array = numbersIn(given, "lengths");
  if (array.ndim() == 0)
    return std::vector<float>(count, *inputOf<float>(array, "lengths", {}).data());
  const auto lengths = inputOf<float>(array, "lengths", {static_cast<py::ssize_t>(count)});
  return {lengths.data(), lengths.data() + count};
}

/// `radius`: none for rays.
py::object cast(const RayCaster& caster, std::optional<float> radius, const py::object& origins,
                const py::object& directions, const py::object& lengths,
                const py::object& threads) {
  const std::vector<Vec3> from = pointsOf(origins, "origins");
  const std::vector<Vec3> along = pointsOf(directions, "directions");
  const std::vector<float> ways = lengthsOf(lengths, from.size());
  const std::uint32_t thread_count = threadsOf(threads);
  std::vector<CastHit> hits(from.size());
  {
    const py::gil_scoped_release unlocked;
    const CastLines lines{from, along, ways};
    if (radius) {
      caster.sweepSpheres(*radius, lines, hits, thread_count);
    } else {
      caster.castRays(lines, hits, thread_count);
    }
  }
  const Shape shape{static_cast<py::ssize_t>(hits.size())};
  Filled<float> distances(shape);
  Filled<std::uint8_t> ends(shape);
  Filled<std::int32_t> indices(shape);
  for (const CastHit& hit : hits) {
    distances.put(hit.distance);
    ends.put(static_cast<std::uint8_t>(hit.end));
    indices.put(hit.index);
  }
  return py::module_::import("galactic.cast_hits")
      .attr("CastHits")(distances.array(), ends.array(), indices.array());
}

py::object castRays(const RayCaster& caster, const py::object& origins,
                    const py::object& directions, const py::object& lengths,
                    const py::object& threads) {
  return cast(caster, std::nullopt, origins, directions, lengths, threads);
}

py::object sweepSpheres(const RayCaster& caster, float radius, const py::object& origins,
                        const py::object& directions, const py::object& lengths,
                        const py::object& threads) {
  return cast(caster, radius, origins, directions, lengths, threads);
}

}  // namespace

void bindRayCaster(py::module_& module) {
  bindEnum(module, "CastEnd",
           {{"NOTHING", static_cast<int>(CastEnd::kNothing)},
            {"SCENE", static_cast<int>(CastEnd::kScene)},
            {"OBJECT", static_cast<int>(CastEnd::kObject)},
            {"ROBOT", static_cast<int>(CastEnd::kRobot)},
            {"OUTSIDE", static_cast<int>(CastEnd::kOutside)}},
           "What a ray or a sphere comes to: nothing on all its way, the static scene, an object,\n"
           "the robot, or the end of the column grid, which does not know what comes then.");
  const py::object infinity = py::float_(std::numeric_limits<double>::infinity());
  py::class_<RayCaster> type(module, "RayCaster");
  type.def(py::init(&casterOfScene), py::arg("world"), py::arg("scene"), py::keep_alive<1, 2>(),
           "Of the static scene alone; of_env() has objects. scene: index into World.scenes.")
      .def_static("of_env", &casterOfEnv, py::arg("simulator"), py::arg("env") = 0, py::kw_only(),
                  py::arg("robot").noconvert() = false,
                  "Of an env as it is now: with its objects where they are and, with robot=True,\n"
                  "the robot and what it holds. Make another one after a step.")
      .def(
          "cast_rays", &castRays, py::arg("origins"), py::arg("directions"),
          py::arg("lengths") = infinity, py::kw_only(), py::arg("threads") = 1,
          "How far rays get, from origins, (n, 3), in directions, (n, 3), of any length but zero:\n"
          "CastHits.\n\n"
          "lengths: how far to go at most, meters, for all or (n,). Boxes of objects and spheres\n"
          "of the robot are hit on their surfaces; the scene is what the grid of the smallest\n"
          "radius says: where a sphere of that radius would touch it. threads: 0 for all.")
      .def("sweep_spheres", &sweepSpheres, py::arg("radius"), py::arg("origins"),
           py::arg("directions"), py::arg("lengths") = infinity, py::kw_only(),
           py::arg("threads") = 1,
           "How far spheres get before they touch something: CastHits, as of cast_rays().\n\n"
           "radius: one of World.radii. origins: where their centers begin.");
  type.doc() =
      "Casts rays and sweeps spheres through a home as the simulation knows it. It never changes.";
  type.attr("__module__") = "galactic";
  refusePickling(type, "make one from its world or simulator");
}

}  // namespace galactic::python
