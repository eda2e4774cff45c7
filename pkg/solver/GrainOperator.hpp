// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BodyBlocks.hpp"
#include "Colouring.hpp"
#include "Crew.hpp"
#include "CrushedContacts.hpp"
#include "GeneralContact.hpp"
#include "NaturalMap.hpp"
#include "SolveReport.hpp"

#include <algorithm>
#include <vector>

namespace contactdynamics {

/// W = H^T M^-1 H of a collection of rigid bodies, matrix-free, as guardedLoop() uses it, with the work space of a solve.
///
/// A candidate far from closing costs next to nothing: it sleeps, that is, no sweep visits it; mend() looks at all sleepers and wakes those that
/// close. Awake contacts are laid out by colour in packs of four; woken ones are appended as colours of their own, and now and then the layout is
/// made anew without the contacts that turned out idle. A problem beyond the caches is laid out block by block of neighbouring bodies, and each block
/// by colour. All of it depends on the problem alone.
class GrainOperator {
public:
	/// Takes the problem over until finish(): free velocities and start impulses, brought inside their cones.
	/// @param crew  does the work from a few thousand contacts on; must outlive the use of the operator
	void start(GrainProblem& problem, bool accelerated, Crew& crew);
	static bool isWorthThreads(std::size_t contacts) { return contacts >= 3000; } ///< below, handing out the colours costs more than it brings
	static constexpr std::size_t blockwiseFrom = 40000; ///< contacts from which on a sweep goes block by block: it no longer fits the caches
	static constexpr int firstCheck = 0;				///< a certificate costs a sweep: wait until the increments promise convergence
	static constexpr bool startsPlainly = true;
	bool anyAwake() const { return awake > 0; }
	std::size_t awakeContacts() const { return awake; } ///< those that a sweep visits
	std::size_t movingBodies() const { return std::size_t(std::count(movable.begin(), movable.end(), 1)); }

	SweepNorms sweep(Extrapolation by);
	bool mend();
	double certificate();
	void keep();
	void exchangeKept();

	/// Contacts that impulses, however large, do not stop, at the point of the last certificate(). None where standing still is admissible for all
	/// that can move: then there is a solution, however slowly it is approached (a light grain between a wall and a heavy one).
	CrushedContacts crushed(double tolerance) const;

	/// Writes velocities, impulses and status of the last certificate() into the problem, and the counts into the report.
	void finish(SolveReport& report);

private:
	static constexpr std::size_t perRun = 512; // contacts or bodies that one job of the crew looks at

	struct Chunk { // a run of contacts of one colour, or of one block, visited by one thread, summed as one term
		std::size_t firstPack, packs, firstGeneral, generals;
		std::size_t firstSeat, lastSeat; // of the block: bodies to be moved to the extrapolated point before the contacts are visited
	};
	struct Group { // chunks that no body links
		std::size_t firstChunk, lastChunk;
	};
	struct Sleeper {
		Vector3 normal;
		double offset; // gap velocity plus image velocity along the normal
		double reach;  // arms along the normal, body 1 minus body 2: what the mean field acts on
		std::int32_t body1, body2, id;
		bool turns; // the rotation of the bodies changes the normal velocity
	};
	struct Sums {
		ResidualSum residual;
		double approach = 0, speeds = 0; // largest
		bool closes = false;
	};

	struct Course { // of a ball contact, kept while the contacts are laid out anew
		double increment[3], direction[3];
	};

	GrainProblem* problem = nullptr;
	BallSweep ballSweep = selectBallSweep();
	BodyAdvance bodyAdvance = selectBodyAdvance();
	BallRebuild ballRebuild = selectBallRebuild();
	BallCertify ballCertify = selectBallCertify();
	bool accelerated = false;
	int sweeps = 0;
	Crew* crew = nullptr;
	bool together = false; // the crew is at work
	std::size_t awake = 0;
	double maxApproachSpeed = 0;
	double largestFreeApproach = 0; // without any impulse [m/s]
	double speedLimit = 0;			// speeds above it, 1000 times the fastest at the start, are no excuse for round-off: the iterate diverges [m/s]
	SweepNorms lastNorms;

	// The mean field: sum of r b^T over all contacts [kg m2/s], now, at the start of the last sweep, and in the search direction; L that goes with
	// it.
	Matrix3 moment = Matrix3::Zero(), momentStart = Matrix3::Zero(), momentDirection = Matrix3::Zero(), gradient = Matrix3::Zero();
	double fieldStep = 0; // see startField()
	std::vector<FieldPass> chunkFields;
	std::vector<Matrix3> runMoments;

	std::vector<BodyState> state, sweepStart, direction; // by seat: velocities now, at the start of the last sweep, and of the search direction
	std::vector<std::uint8_t> movable;
	std::vector<Vector3> impulses; // per contact, global axes, inside the cone: those of the start, and from finish() on those of the end
	std::vector<Vector3> kept;	   // likewise
	std::vector<RollingContact> rollingContacts; // parallel to GrainProblem::rolling
	std::vector<Vector3> keptTorques;
	std::vector<std::int32_t> rollingOf; // by contact, -1: none; empty where no contact has rolling friction
	std::vector<std::uint8_t> mustWake;
	std::vector<Sums> sums;
	std::vector<int> active; // contacts that carry an impulse, by run

	bool blockwise = false;
	BodyBlocks blocks;
	std::vector<std::int32_t> seat; // of each body: place of its velocities
	Colouring colouring;
	std::vector<BallPack> packs;
	std::vector<RollingPack> rollingPacks; // parallel to packs; empty where no contact has rolling friction
	std::vector<Course> courses;
	std::vector<GeneralContact> generals, oldGenerals;
	std::vector<Group> groups;
	std::vector<Chunk> chunks;
	std::vector<SweepNorms> chunkNorms;
	std::vector<Sleeper> sleepers;
	std::vector<std::int32_t> place; // of a contact in the old layout
	std::vector<std::int32_t> selected, colourOf, order, byBlock, firstOfBlock;
	std::vector<Chunk> blockChunks;

	static bool isCompliant(const Contact& c) { return c.normalCompliance != 0 || c.tangentialCompliance != 0; }
	bool isBall(const Contact& c) const { return c.ball && c.imageVelocity.isZero(0) && !isCompliant(c); }
	RollingContact* rollingAt(std::int32_t id) { return rollingOf.empty() || rollingOf[id] < 0 ? nullptr : &rollingContacts[rollingOf[id]]; }
	/// Calls job(0) ... job(count - 1) in any order; each may write only what belongs to its index.
	template <class Job> void share(std::size_t count, const Job& job)
	{
		if (together)
			crew->run(count, job);
		else
			for (std::size_t i = 0; i < count; ++i) job(i);
	}
	/// The same in runs of many.
	template <class Job> void inRuns(std::size_t count, const Job& job)
	{
		share((count + perRun - 1) / perRun, [&](std::size_t k) {
			for (std::size_t i = k * perRun; i < std::min(count, (k + 1) * perRun); ++i) job(i);
		});
	}
	std::int32_t indexOf(std::int32_t body) const { return movable[body] ? seat[body] : ~seat[body]; }
	BodyState& stateOf(std::int32_t body) { return state[seat[body]]; }
	const BodyState& stateOf(std::int32_t body) const { return state[seat[body]]; }
	double normalVelocity(const Sleeper& s) const;
	double normalVelocity(const Contact& c) const;
	void addImpulse(const Contact& c, const Vector3& impulse);
	void startRolling();
	void beginAtTorques();
	RollingPack* rollingFrom(std::size_t pack) { return rollingContacts.empty() ? nullptr : rollingPacks.data() + pack; }
	void collectTorques();
	void addTorque(const Contact& c, const Vector3& torque);
	void takeSeats();
	void beginAtImpulses();
	void layOut(const std::vector<std::int32_t>& ids);
	void layOutByColour(const std::vector<std::int32_t>& ids);
	void layOutByBlock(const std::vector<std::int32_t>& ids);
	void colourBlock(std::size_t block);
	void fillBlock(std::size_t block);
	BallPack emptyPack() const;
	void putBall(std::size_t at, int lane, std::int32_t id);
	void resizePacks(std::size_t count);
	void putGeneral(GeneralContact& g, std::int32_t id);
	void putSleeper(std::int32_t id);
	void letIdleSleep();
	void extrapolate(Extrapolation by, std::size_t firstSeat, std::size_t lastSeat);
	bool hasField() const { return problem->meanField.has_value(); }
	void startField();
	void startFieldPass(Extrapolation by);
	void addFieldPasses();
	double mobility(double W, const Contact& c) const;
	void visit(const Chunk& chunk, SweepNorms& norms, Extrapolation by, FieldPass* field);
	void collectImpulses(std::vector<Vector3>& r);
	double speedsAt(const Contact& c) const;
	bool mayStandStill() const;
	void freeVelocities();
	void rebuildVelocities();
	void sumMoment();
	Vector3 relativeVelocity(const Contact& c) const;
	Matrix3 compliantDelassus(const Contact& c, const Matrix3& frame) const;
	void certify(const RollingContact& rolling, const Contact& c, double normalImpulse, Sums& total) const;
	void certify(const Contact& c, const Matrix3& frame, const Matrix3& W, const Vector3& r, Sums& total) const;
};

} // namespace contactdynamics
