#pragma once
#include <random>
#include <vector>

#include "galactic/batch_renderer.h"
#include "support/packs/render_model_builder.h"

namespace galactic {

/// An apartment of six rooms for measurements, about 82,000 triangles with all that stands in it:
/// model 0 is the rooms with their furniture, models 1 to 20 links of a robot, the rest movable
/// objects. Textures of 512 x 512 texels.
[[nodiscard]] test::RenderModelBuilder apartmentMeshes();

/// The rooms, a robot and the objects, both at places that differ from env to env.
[[nodiscard]] std::vector<RenderInstance> furnishedApartment(const RenderLibrary& library,
                                                             std::mt19937& random);

/// All models of a library where their packs have them.
[[nodiscard]] std::vector<RenderInstance> everyModel(const RenderLibrary& library);

/// A camera at 1.2 m above the floor of one of the rooms, looking slightly down, 90 degrees.
[[nodiscard]] RenderCamera cameraInApartment(std::mt19937& random);

}  // namespace galactic
