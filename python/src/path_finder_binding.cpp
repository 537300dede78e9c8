#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "galactic/error.h"
#include "galactic/path_finder.h"
#include "options.h"

namespace galactic::python {
namespace {

constexpr py::ssize_t kNumbers = 3;

/// Drops the yaw from bases (4,) or (n, 4), such as EpisodeTable.base; returns anything else
/// unchanged.
py::object withoutYaw(const py::handle& given) {
  const py::array rows = py::array::ensure(given);
  if (!rows) PyErr_Clear();
  if (!rows || rows.ndim() == 0 || rows.shape(rows.ndim() - 1) != kNumbers + 1) {
    return py::reinterpret_borrow<py::object>(given);
  }
  return rows[py::make_tuple(py::ellipsis(), py::slice(0, kNumbers, 1))];
}

std::vector<Vec3> basesOf(const py::handle& given) { return pointsOf(withoutYaw(given), "bases"); }

Vec3 baseOf(const py::handle& given, const char* name) {
  const std::vector<float> numbers = finiteNumbers(withoutYaw(given), name, kNumbers);
  return {numbers[0], numbers[1], numbers[2]};
}

/// float32 (n, 3).
py::array_t<float> rowsOf(std::span<const Vec3> points) {
  py::array_t<float> rows({static_cast<py::ssize_t>(points.size()), kNumbers});
  float* numbers = rows.mutable_data();
  for (const Vec3& point : points) {
    *numbers++ = point.x;
    *numbers++ = point.y;
    *numbers++ = point.z;
  }
  return rows;
}

/// The goal of each of `count` bases: from `given`, or the first goal.
std::vector<std::size_t> goalsOf(const GeodesicFields& fields, const py::object& given,
                                 std::size_t count) {
  std::vector<std::size_t> which(count);
  if (given.is_none()) {
    if (count > 0 && fields.size() == 0) throw py::index_error("there is no goal");
    return which;
  }
  const auto numbers = wholeNumbersOf(given, "goals", {static_cast<py::ssize_t>(count)});
  for (std::size_t n = 0; n < count; ++n) {
    const std::int64_t goal = numbers.data()[n];
    if (goal < 0 || static_cast<std::size_t>(goal) >= fields.size()) {
      throw py::index_error(
          fmt::format("goals[{}] is {}, and there are {}", n, goal, fields.size()));
    }
    which[n] = static_cast<std::size_t>(goal);
  }
  return which;
}

py::array_t<float> distances(const GeodesicFields& fields, const py::object& bases,
                             const py::object& goals) {
  const std::vector<Vec3> from = basesOf(bases);
  const std::vector<std::size_t> which = goalsOf(fields, goals, from.size());
  py::array_t<float> lengths(static_cast<py::ssize_t>(from.size()));
  for (std::size_t n = 0; n < from.size(); ++n) {
    lengths.mutable_data()[n] = fields.way(which[n], from[n]).distance;
  }
  return lengths;
}

py::array_t<float> directions(const GeodesicFields& fields, const py::object& bases,
                              const py::object& goals) {
  const std::vector<Vec3> from = basesOf(bases);
  const std::vector<std::size_t> which = goalsOf(fields, goals, from.size());
  std::vector<Vec3> ways;
  ways.reserve(from.size());
  for (std::size_t n = 0; n < from.size(); ++n) {
    const GeodesicWay way = fields.way(which[n], from[n]);
    ways.push_back({way.x, 0, way.z});
  }
  return rowsOf(ways);
}

py::array_t<float> path(const GeodesicFields& fields, const py::object& base,
                        const py::object& goal) {
  const std::uint64_t number = wholeOf("goal", goal, 0, std::numeric_limits<std::uint32_t>::max());
  if (number >= fields.size()) {
    throw py::index_error(fmt::format("there is no goal {}, there are {}", number, fields.size()));
  }
  return rowsOf(fields.path(number, baseOf(base, "base")));
}

std::unique_ptr<PathFinder> makeFinder(const World& world, const py::object& scene,
                                       const py::object& start, const py::object& rise,
                                       const py::object& drop) {
  const std::uint64_t last = world.scenes().size() - 1;
  const auto number = static_cast<std::uint32_t>(wholeOf("scene", scene, 0, last));
  const Vec3 place = baseOf(start, "start");
  py::dict keywords;
  keywords["floor_rise"] = rise;
  keywords["floor_drop"] = drop;
  const GroundOptions ground = optionsOf(world, keywords).ground;
  const py::gil_scoped_release unlocked;
  return std::make_unique<PathFinder>(orThrow(PathFinder::create(world, number, place, ground)));
}

/// The shape of arrays over all cells: (columns in Z, columns in X).
Shape cellsOf(const PathFinder& finder) { return {finder.columnsZ(), finder.columnsX()}; }

py::array_t<bool> navigable(const PathFinder& finder) {
  py::array_t<bool> cells(cellsOf(finder));
  std::ranges::transform(finder.heights(), cells.mutable_data(),
                         [](float height) { return !std::isnan(height); });
  return cells;
}

py::array_t<bool> areNavigable(const PathFinder& finder, const py::object& bases) {
  const std::vector<Vec3> places = basesOf(bases);
  py::array_t<bool> result(static_cast<py::ssize_t>(places.size()));
  std::ranges::transform(places, result.mutable_data(),
                         [&](const Vec3& place) { return finder.isNavigable(place); });
  return result;
}

py::array_t<float> snapped(const PathFinder& finder, const py::object& points) {
  std::vector<Vec3> places = pointsOf(points, "points");
  {
    const py::gil_scoped_release unlocked;
    for (Vec3& place : places) place = finder.snap(place);
  }
  return rowsOf(places);
}

GeodesicFields fieldsTo(const PathFinder& finder, const py::object& goals, bool hand,
                        const py::object& threads) {
  const std::vector<Vec3> points = pointsOf(goals, "goals");
  const GoalOf of = hand ? GoalOf::kHand : GoalOf::kBase;
  const std::uint32_t count = threadsOf(threads);
  const py::gil_scoped_release unlocked;
  return orThrow(finder.fieldsTo(points, of, count));
}

void bindFields(py::module_& module) {
  py::class_<GeodesicFields> type(module, "GeodesicFields");
  type.def("__len__", &GeodesicFields::size)
      .def_property_readonly(
          "goals", [](const GeodesicFields& fields) { return rowsOf(fields.goals()); },
          "The goals: float32 (k, 3), world frame, meters.")
      .def("distances", &distances, py::arg("bases"), py::arg("goals") = py::none(),
           "Lengths of the shortest paths, meters: float32 (n,), inf if there is none within\n"
           "127 m.\n\n"
           "bases: (n, 3), positions of bases or roots, at most three cells beside the floor\n"
           "and half a meter above it, or (n, 4) with a yaw, which is ignored. goals: int (n,),\n"
           "the goal for each base; None: the first goal for all.")
      .def("directions", &directions, py::arg("bases"), py::arg("goals") = py::none(),
           "Unit directions in which the shortest paths begin, world frame: float32 (n, 3), y\n"
           "is 0; zeros if there is no path, and at its end. bases, goals: as in distances().")
      .def("path", &path, py::arg("base"), py::arg("goal") = 0,
           "Corners of a path of straight lines over the floor, float32 (m, 3), from the base,\n"
           "(3,) or (4,), to a goal, or to where the hand reaches it; (0, 3) if there is no\n"
           "path.");
  type.doc() =
      "Shortest paths along a floor to k goals from everywhere, as returned by\n"
      "PathFinder.fields().";
  type.attr("__module__") = "galactic";
  refusePickling(type, "make them with PathFinder.fields()");
}

}  // namespace

void bindPathFinder(py::module_& module) {
  bindFields(module);
  py::class_<PathFinder> type(module, "PathFinder");
  type.def(py::init(&makeFinder), py::arg("world"), py::arg("scene"), py::arg("start"),
           py::kw_only(), py::arg("floor_rise") = py::none(), py::arg("floor_drop") = py::none(),
           py::keep_alive<1, 2>(),
           "Explores the floor at or under `start`, (3,) or (4,), the position of a base or a\n"
           "root. The floor consists of the cells of size `cell_size` in which the robot's\n"
           "start pose is free of the static scene in some heading, and which are connected by\n"
           "steps within floor_rise and floor_drop. Objects are ignored. scene: index into\n"
           "World.scenes. Raises galactic.Error if the robot cannot stand at `start`.")
      .def_property_readonly_static("cell_size",
                                    [](const py::object&) { return PathFinder::cellSize(); })
      .def_property_readonly(
          "origin",
          [](const PathFinder& finder) { return py::make_tuple(finder.minX(), finder.minZ()); },
          "x and z of the corner of cell (0, 0), world frame, meters.")
      .def_property_readonly("navigable", &navigable,
                             "bool (cells along Z, cells along X): a map of the floor from above.")
      .def_property_readonly(
          "heights",
          [](const PathFinder& finder) {
            py::array_t<float> cells(cellsOf(finder));
            std::ranges::copy(finder.heights(), cells.mutable_data());
            return cells;
          },
          "Heights of the floor, meters: float32, of the shape of `navigable`; NaN where the\n"
          "robot cannot go.")
      .def_property_readonly(
          "places", [](const PathFinder& finder) { return rowsOf(finder.places()); },
          "float32 (m, 3): the centers of all navigable cells. Draw from these for random\n"
          "places.")
      .def("is_navigable", &areNavigable, py::arg("bases"),
           "Whether bases, (n, 3) or (n, 4), are at navigable places: bool (n,).")
      .def("snap", &snapped, py::arg("points"),
           "The nearest of `places` for each of the points, (n, 3): float32 (n, 3).")
      .def("fields", &fieldsTo, py::arg("goals"), py::kw_only(),
           py::arg("hand").noconvert() = false, py::arg("threads") = 0,
           "Shortest paths to goals, (k, 3), from everywhere on the floor: GeodesicFields.\n"
           "Goals are navigable places of the base or, with hand=True, points for the hand to\n"
           "reach, as in the sensor `geodesic`. threads: 0 for all.")
      .def("__repr__", [](const PathFinder& finder) {
        return fmt::format("<galactic.PathFinder of {} places>", finder.places().size());
      });
  type.doc() =
      "Where the robot of a world can drive on one floor of a scene, and shortest paths there.\n"
      "Maps have cells of `cell_size`, meters.";
  type.attr("__module__") = "galactic";
  refusePickling(type, "make one from its world");
}

}  // namespace galactic::python
