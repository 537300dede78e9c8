#pragma once
#include <string>

#include "galactic/episode_set.h"

namespace galactic::pack_tool {

/// Which way is up in the frames of the objects' mesh files.
enum class FileUp { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };

/// A published episode set (JSON, `*.episode_set.json`) of what a pack holds: scenes, objects,
/// spawns in the order of the placements, and episodes. Poses turn from the frame of the objects'
/// packs (Y up) to that of their mesh files, whose up axis is `up`; quaternions stand as w, x, y,
/// z. Every number reads back exactly: what was imported with the same `up`, exported and imported
/// again is the same. Three keys are galactic's own: the robot's name ("robot"), the names of the
/// start joints ("startJoints"), and, where it is not 0, the height of a start
/// ("agentStartHeight"). A scene has one render asset of its name, at the origin.
[[nodiscard]] std::string episodeSetText(const EpisodeSet& set, FileUp up);

}  // namespace galactic::pack_tool
