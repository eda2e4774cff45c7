// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <abi/CompileDefinitions.hpp>

// Python.h has to come before the standard headers.
#include <boost/python.hpp>
#include <boost/shared_ptr.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cassert>
#include <cmath>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#define YADE_CAST static_cast
#define YADE_PTR_CAST ::boost::static_pointer_cast
#define YADE_PTR_DYN_CAST ::boost::dynamic_pointer_cast

namespace yade {

using boost::shared_ptr;
using std::cerr;
using std::cout;
using std::endl;
using std::invalid_argument;
using std::logic_error;
using std::make_pair;
using std::pair;
using std::runtime_error;
using std::string;
using std::swap;
using std::vector;

using Real = double;
using mask_t = int;

using Vector2r = Eigen::Matrix<Real, 2, 1>;
using Vector2i = Eigen::Matrix<int, 2, 1>;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Vector3i = Eigen::Matrix<int, 3, 1>;
using Vector6r = Eigen::Matrix<Real, 6, 1>;
using Matrix3r = Eigen::Matrix<Real, 3, 3>;
using Quaternionr = Eigen::Quaternion<Real>;
using AngleAxisr = Eigen::AngleAxis<Real>;

const Real NaN = std::numeric_limits<Real>::quiet_NaN();

/// A placement of a body: position [m] and orientation, from the body's frame to the global one.
template <class Scalar> class Se3 {
public:
	Eigen::Matrix<Scalar, 3, 1> position;
	Eigen::Quaternion<Scalar> orientation;

	Se3() = default;
	Se3(const Eigen::Matrix<Scalar, 3, 1>& position, const Eigen::Quaternion<Scalar>& orientation) : position(position), orientation(orientation) {}
};
using Se3r = Se3<Real>;

} // namespace yade

#include <abi/MathSerialization.hpp>
