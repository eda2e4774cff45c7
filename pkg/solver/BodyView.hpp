// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BallPack.hpp"

#include <Eigen/Core>

namespace contactdynamics {

/// The plain arrays of a BodyState as vectors.
inline Eigen::Map<const Eigen::Vector3d> velocity(const BodyState& body) { return Eigen::Map<const Eigen::Vector3d>(body.velocity); }
inline Eigen::Map<const Eigen::Vector3d> angularVelocity(const BodyState& body) { return Eigen::Map<const Eigen::Vector3d>(body.angularVelocity); }
inline Eigen::Map<Eigen::Vector3d> velocity(BodyState& body) { return Eigen::Map<Eigen::Vector3d>(body.velocity); }
inline Eigen::Map<Eigen::Vector3d> angularVelocity(BodyState& body) { return Eigen::Map<Eigen::Vector3d>(body.angularVelocity); }

} // namespace contactdynamics
