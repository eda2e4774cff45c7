// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/serialization/Serializable.hpp>

namespace yade {

/// The periodic cell: a parallelepiped whose edges are the columns of `hSize`.
class Cell : public Serializable {
	YADE_STOCK_SERIALIZABLE(Cell)

	friend struct abi::PrivateMembers;

private:
	abi::Opaque<24, 168> inverseAndIncrement;
	Matrix3r _vGradTimesPrevH;
	Vector3r _size;
	Vector3r _cos;
	abi::Opaque<288, 312> reference;
	bool _hasShear;
	abi::Opaque<313, 320> afterHasShear;
	Matrix3r _shearTrsf;
	Matrix3r _unshearTrsf;
	abi::Opaque<464, 592> forDrawing;

public:
	Matrix3r trsf; ///< deformation gradient since the start
	Matrix3r refHSize;
	Matrix3r hSize;		  ///< edges [m]
	Matrix3r prevHSize;	  ///< edges in the step before [m]
	Matrix3r velGrad;	  ///< velocity gradient of this step [1/s]
	Matrix3r nextVelGrad; ///< what `velGrad` becomes in the next step if `velGradChanged` [1/s]
	Matrix3r prevVelGrad; ///< velocity gradient of the step before [1/s]
	int homoDeform;		  ///< one of HOMO_*: how bodies follow the cell
	bool velGradChanged;
	bool flipFlippable;

	enum { HOMO_NONE = 0, HOMO_POS = 1, HOMO_VEL = 2, HOMO_VEL_2ND = 3 };

	Cell();

	/// Moves the cell by h times its velocity gradient and derives size, shear and the like from `hSize` and `trsf`.
	void integrateAndUpdate(Real h);

	const Vector3r& getSize() const { return _size; }
	/// Cosines of the skew angles in the yz, xz and xy planes.
	const Vector3r& getCos() const { return _cos; }
	bool hasShear() const { return _hasShear; }
	const Matrix3r& getShearTrsf() const { return _shearTrsf; }
	const Matrix3r& getUnshearTrsf() const { return _unshearTrsf; }
	Vector3r shearPt(const Vector3r& point) const { return _shearTrsf * point; }
	Vector3r unshearPt(const Vector3r& point) const { return _unshearTrsf * point; }
	Vector3r wrapShearedPt(const Vector3r& point) const;

	/// By how much body 2 of an interaction is displaced [m], and how much faster it is there [m/s].
	Vector3r intrShiftPos(const Vector3i& cellDist) const { return hSize * cellDist.cast<Real>(); }
	Vector3r intrShiftVel(const Vector3i& cellDist) const { return _vGradTimesPrevH * cellDist.cast<Real>(); }
	/// Velocity without the mean field of the cell [m/s].
	Vector3r bodyFluctuationVel(const Vector3r& position, const Vector3r& velocity, const Matrix3r& velocityGradient) const
	{
		return velocity - velocityGradient * position;
	}
};

} // namespace yade
