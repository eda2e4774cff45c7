// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <boost/serialization/is_bitwise_serializable.hpp>
#include <boost/serialization/nvp.hpp>

// How vectors, matrices and placements stand in an archive. Names and order are YADE's file format: a scene saved by a plugin built here loads
// in one built against YADE's own headers, and the other way round.

// Without version and object tracking, and in binary archives as one block for a whole std::vector.
BOOST_IS_BITWISE_SERIALIZABLE(yade::Vector2r)
BOOST_IS_BITWISE_SERIALIZABLE(yade::Vector2i)
BOOST_IS_BITWISE_SERIALIZABLE(yade::Vector3r)
BOOST_IS_BITWISE_SERIALIZABLE(yade::Vector3i)
BOOST_IS_BITWISE_SERIALIZABLE(yade::Matrix3r)
BOOST_IS_BITWISE_SERIALIZABLE(yade::Quaternionr)
BOOST_IS_BITWISE_SERIALIZABLE(yade::Se3r)

// Templates over the scalar type, unlike YADE's own functions: another signature, so the dynamic linker cannot take one for the other.
namespace boost::serialization {

template <class Archive, class Scalar, int rows> void serialize(Archive& archive, Eigen::Matrix<Scalar, rows, 1>& vector, const unsigned int)
{
	static_assert(rows == 2 || rows == 3, "only Vector2 and Vector3 attributes can be saved");
	static const char* const names[] = {"x", "y", "z"};
	for (int i = 0; i < rows; ++i) archive& make_nvp(names[i], vector[i]);
}

template <class Archive, class Scalar> void serialize(Archive& archive, Eigen::Matrix<Scalar, 3, 3>& matrix, const unsigned int)
{
	static const char* const names[] = {"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"};
	for (int row = 0; row < 3; ++row)
		for (int column = 0; column < 3; ++column) archive& make_nvp(names[3 * row + column], matrix(row, column));
}

template <class Archive, class Scalar> void serialize(Archive& archive, Eigen::Quaternion<Scalar>& quaternion, const unsigned int)
{
	archive& make_nvp("w", quaternion.w());
	archive& make_nvp("x", quaternion.x());
	archive& make_nvp("y", quaternion.y());
	archive& make_nvp("z", quaternion.z());
}

template <class Archive, class Scalar> void serialize(Archive& archive, yade::Se3<Scalar>& placement, const unsigned int)
{
	archive& make_nvp("position", placement.position);
	archive& make_nvp("orientation", placement.orientation);
}

} // namespace boost::serialization
