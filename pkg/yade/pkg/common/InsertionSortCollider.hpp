// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <pkg/common/Collider.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>

namespace yade {

/// The collider of nearly all scripts.
class InsertionSortCollider : public Collider {
	YADE_STOCK_SERIALIZABLE(InsertionSortCollider)

	bool strideActive;

private:
	abi::Opaque<125, 352> sortedBounds;

public:
	int sortAxis;
	bool allowBiggerThanPeriod;

private:
	abi::Opaque<357, 360> afterSwitches;

public:
	int targetInterv;
	Real overlapTolerance;
	Real updatingDispFactor;
	Real verletDist; ///< by how much bounds are enlarged, so that the collider need not run in every step [m]
	Real minSweepDistFactor;
	Real fastestBodyMaxDist; ///< largest displacement since the bounds were last computed [m]
	int numReinit;
	int numAction;

private:
	abi::Opaque<416, 424> switches;

public:
	shared_ptr<NewtonIntegrator> newton;

	InsertionSortCollider() = delete;
	bool isActivated() override;
	void action() override;
	vector<Body::id_t> probeBoundingVolume(const Bound& bound) override;
	void invalidatePersistentData() override;
};

} // namespace yade
