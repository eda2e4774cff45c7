// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "ContactKernels.hpp"
#include "BodyTree.hpp"
#include "Colouring.hpp"
#include "Crew.hpp"
#include "HotSpot.hpp"
#include "ImpulseSet.hpp"
#include "NaturalMap.hpp"
#include "PackList.hpp"
#include "RollingContact.hpp"
#include "SolveReport.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

namespace contactdynamics {

/// W = H^T M^-1 H of a collection of rigid bodies, matrix-free, as guardedLoop() uses it, with the work space of a solve.
///
/// A candidate far from closing costs next to nothing: it sleeps, that is, no sweep visits it; mend() looks at all sleepers and wakes those that
/// close. Awake contacts are laid out node by node of the tree of bodies, each node by colour in packs; woken ones are appended as chunks of
/// their own, and now and then the layout is made anew without the contacts that turned out idle. All of it depends on the problem alone.
class GrainOperator {
public:
	/// Takes the problem over until finish(): free velocities and start impulses, brought inside their cones.
	/// @param crew  does the work from a few thousand contacts on; must outlive the use of the operator
	void start(GrainProblem& problem, bool accelerated, Crew& crew);
	/// From two regions of the least length on: a sweep over 1600 contacts takes two cores far apart (240 ns for a line) 12.5 microseconds, one 10.8.
	static bool isWorthThreads(std::size_t contacts) { return contacts > 2 * contactsPerRegion; }
	static constexpr int firstCheck = 0; ///< a certificate costs a sweep: wait until the increments promise convergence
	static constexpr bool startsPlainly = true;
	bool anyAwake() const { return awake > 0; }
	std::size_t awakeContacts() const { return awake; } ///< those that a sweep visits
	std::size_t movingBodies() const { return std::size_t(std::count(movable.begin(), movable.end(), 1)); }

	SweepNorms sweep(Extrapolation by);
	bool mend();
	double certificate();
	void keep();
	void exchangeKept();

	/// The contacts around the largest changes of the last sweep. False where these are spread too far, and where there is a mean field or rolling
	/// friction: with them no time was gained (doc/grains.rst).
	bool chooseHotSpot(HotSpot& spot) const;
	/// One of its parts, with the present impulses; the bodies are as they would be without them. @return  sum of r^T W r [J]
	double takePart(HotSpot& spot, std::size_t part, GrainProblem& taken) const;
	/// The impulses of its problem in the place of those taken since the last sweep.
	void putPart(const HotSpot& spot, std::size_t part, const GrainProblem& solved);
	double impulse2() const { return lastNorms.impulse2; } ///< of the last sweep [J]

	/// Approach at the point of the last certificate() over the largest without any impulse.
	double approachLeft() const { return maxApproachSpeed > 0 ? maxApproachSpeed / largestFreeApproach : 0; }
	/// After finish(): what the last visit of each contact has added.
	void lastIncrements(ImpulseSet& added) const;

	/// Writes velocities, impulses and status of the last certificate() into the problem, and the counts into the report.
	void finish(SolveReport& report);

private:
	/// At most, in the mean: 10 to 15 microseconds of work, some ten times as much as it costs two cores to hand over what they share.
	static constexpr std::size_t contactsPerRegion = 1500;
	static constexpr int mostLevels = 6;	   // of the tree of bodies above its regions: 64 regions are enough for any number of threads
	static constexpr std::size_t perRun = 512; // contacts or bodies that one job of the crew looks at

	struct Chunk { // contacts of one node, summed as one term
		std::size_t firstPack, packs, firstGeneral, generals;
		std::size_t firstSeat, lastSeat; // of a block: bodies to be moved to the extrapolated point before the contacts are visited
	};
	struct Pass { // one layout: all awake contacts, or some that woke later
		std::size_t firstChunk, lastChunk, firstJob;
		bool isShared; // there is a range of chunks for each job of the tree
	};
	struct Range {
		std::size_t firstChunk, lastChunk;
	};
	struct alignas(64) Arrivals { // at a joint: the second one goes on; written by two threads
		std::atomic<unsigned> count{0};
	};
	struct Sleeper {
		Vector3 normal;
		double offset; // gap velocity plus image velocity along the normal
		double reach;  // of balls: arms along the normal, body 1 minus body 2, what the mean field acts on
		std::int32_t body1, body2, id;
		std::int32_t turning; // where its Turning is, -1 for balls, whose rotation does not change the normal velocity
	};
	struct Turning {
		Vector3 turn1, turn2; // arm x normal
		Vector3 branch;		  // arm1 - arm2
	};
	struct Sums {
		ResidualSum residual;
		double approach = 0, speeds = 0; // largest
		bool closes = false;
		bool anyGeneral = false;
	};

	struct Course { // of a contact, kept while the contacts are laid out anew; in the axes of its pack
		double impulse[3], increment[3], direction[3], slidingRate;
	};

	GrainProblem* problem = nullptr;
	const ContactKernels& kernels = widestContactKernels();
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
	std::vector<double> closing; // of each contact, at the start [m/s]
	std::vector<Sums> sums;
	std::vector<int> active; // contacts that carry an impulse, by run

	BodyTree tree;
	Colouring colouring;
	PackList<BallPack> packs;
	PackList<GeneralPack> generals;
	PackList<RollingPack> rollingPacks, rollingGenerals; // parallel to packs and generals; empty where no contact has rolling friction
	std::vector<BodyMobility> mobilities;				 // by seat, as state; empty where all contacts are of balls
	std::vector<Course> courses;
	std::vector<Pass> passes;
	std::vector<Range> jobs; // of each shared pass those of the tree
	std::array<Arrivals, 1 << mostLevels> arrivals;
	std::vector<Chunk> chunks;
	std::vector<SweepNorms> chunkNorms;
	std::vector<Sleeper> sleepers;
	std::vector<Turning> turnings;
	std::vector<std::int32_t> place; // of a contact in the old layout
	std::vector<std::int32_t> selected, colourOf, order, byNode, firstOfNode;
	std::vector<Chunk> nodeChunks;

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
	/// Calls visit(job) for all jobs of the tree, a joint after its parts and a stage after all before.
	template <class Visit> void overJobs(const Visit& visit)
	{
		share(tree.regions(), [&](std::size_t region) {
			visit(region);
			for (int level = 1; level <= tree.undivided(); ++level) {
				const std::size_t k = region >> level;
				const bool isSecond = arrivals[(tree.regions() >> level) + k].count.fetch_add(1, std::memory_order_acq_rel) % 2;
				if (!isSecond) break;
				visit(tree.joint(level, k));
			}
		});
		for (std::size_t first = tree.firstPair(); first < tree.jobs(); first += tree.pairsPerStage())
			share(tree.pairsPerStage(), [&](std::size_t k) { visit(first + k); });
	}
	/// Calls visit(chunk) for all chunks in the order of a sweep.
	template <class Visit> void overChunks(const Visit& visit)
	{
		for (const Pass& pass : passes) {
			const auto visitAll = [&](std::size_t first, std::size_t last) {
				for (std::size_t i = first; i < last; ++i) visit(i);
			};
			if (pass.isShared)
				overJobs([&](std::size_t job) { visitAll(jobs[pass.firstJob + job].firstChunk, jobs[pass.firstJob + job].lastChunk); });
			else
				visitAll(pass.firstChunk, pass.lastChunk);
		}
	}
	std::int32_t indexOf(std::int32_t body) const { return movable[body] ? tree.seat[body] : ~tree.seat[body]; }
	BodyState& stateOf(std::int32_t body) { return state[tree.seat[body]]; }
	const BodyState& stateOf(std::int32_t body) const { return state[tree.seat[body]]; }
	const BodyState& stateAt(std::int32_t index) const { return state[index < 0 ? ~index : index]; } // of indexOf()
	double normalVelocity(const Sleeper& s) const;
	double normalVelocity(const Contact& c) const;
	double normalVelocity(const BallPack& pack, int lane) const;
	void addImpulse(const Contact& c, const Vector3& impulse);
	void startRolling();
	void beginAtTorques();
	RollingPack* rollingFrom(std::size_t pack) { return rollingContacts.empty() ? nullptr : rollingPacks.data() + pack; }
	RollingPack* rollingGeneralsFrom(std::size_t pack) { return rollingContacts.empty() ? nullptr : rollingGenerals.data() + pack; }
	void collectTorques();
	void addTorque(const Contact& c, const Vector3& torque);
	void takeSeats();
	void beginAtImpulses();
	void layOut(const std::vector<std::int32_t>& ids);
	void colourNode(std::size_t node);
	void fillNode(std::size_t node);
	/// Calls visit(pack, lane) for each contact.
	template <class Packs, class Visit> static void eachContact(Packs& packs, const Visit& visit)
	{
		for (auto& pack : packs)
			for (int lane = 0; lane < packLanes; ++lane)
				if (pack.id[lane] >= 0) visit(pack, lane);
	}
	void putBall(std::size_t at, int lane, std::int32_t id);
	void putGeneral(std::size_t at, int lane, std::int32_t id);
	static Vector3 inGlobalAxes(const BallPack& pack, const double (&its)[3][packLanes], int lane);
	static Vector3 inGlobalAxes(const GeneralPack& pack, const double (&its)[3][packLanes], int lane);
	void takeMobilities();
	void forgetLayout();
	void putSleeper(std::int32_t id);
	void letIdleSleep();
	double largestChanges(HotSpot& spot, std::size_t most) const;
	void contactsNear(HotSpot& spot) const;
	double growHotSpot(HotSpot& spot, std::size_t most, double enough) const;
	static void divideHotSpot(HotSpot& spot);
	/// visit(pack, lane) of one contact of an operator, const or not.
	template <class Self, class Visit> static auto at(Self& self, HotSpot::PackLane of, const Visit& visit)
	{
		const std::int32_t pack = of.number / packLanes, lane = of.number % packLanes;
		return of.ball ? visit(self.packs[pack], lane) : visit(self.generals[pack], lane);
	}
	static bool isNonzero(const double (&its)[3][packLanes], int lane) { return its[0][lane] != 0 || its[1][lane] != 0 || its[2][lane] != 0; }
	HotSpot::PackLane placeOf(const BallPack& pack, int lane) const;
	HotSpot::PackLane placeOf(const GeneralPack& pack, int lane) const;
	void extrapolate(Extrapolation by, std::size_t firstSeat, std::size_t lastSeat);
	bool hasField() const { return problem->meanField.has_value(); }
	void startField();
	void startFieldPass(Extrapolation by);
	void addFieldPasses();
	double mobility(double W, const Contact& c) const;
	void visit(const Chunk& chunk, SweepNorms& norms, Extrapolation by, FieldPass* field);
	void collectImpulses(std::vector<Vector3>& r);
	double speedsAt(const Contact& c) const;
	void freeVelocities();
	void rebuildVelocities();
	void sumMoment();
	Vector3 relativeVelocity(const Contact& c) const;
	Matrix3 compliantDelassus(const Contact& c, const Matrix3& frame) const;
	void certifyWithout(const Contact& c, Sums& total) const;
};

} // namespace contactdynamics
