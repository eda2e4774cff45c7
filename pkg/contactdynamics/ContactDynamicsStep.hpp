// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "FreeMotion.hpp"
#include "PenetrationRepair.hpp"
#include "ShiftedContacts.hpp"
#include <boost/python/dict.hpp>
#include <boost/python/list.hpp>
#include <cstdint>
#include <optional>
#include <pkg/solver/BlockProblem.hpp>
#include <pkg/solver/SignoriniCoulombSolver.hpp>
#include <string>
#include <vector>

namespace yade {

class ContactDynamicsManifoldPhys;
class ContactDynamicsPhys;
class Interaction;
class ManifoldGeom;
class Scene;
struct SurfaceContact;

/// One step of ContactDynamicsEngine in flat arrays: the scene is gathered once, solved, and scattered once.
/// Bodies and contacts are ordered by id, so the problem does not depend on threads or on the order in which YADE met the pairs.
struct ContactDynamicsStep {
	struct Twist {
		Vector3r velocity, angularVelocity;
	};

	contactdynamics::GrainProblem problem;
	int planeAxis = -1;						  // normal to the plane of a two-dimensional scene, see PlaneOfMotion
	int activeContacts = 0;					  // of the last apply()
	Real maxPenetration = 0;				  // [m]
	Real meanPenetration = 0;				  // [m], mean over the active contacts
	Real elasticEnergy = 0;					  // of compliant contacts [J], while O.trackEnergy
	Real remainingOverlap = 0;				  // largest at the end of the step, repair included [m]
	Real repairDisplacement = 0;			  // see PenetrationRepair::largestDisplacement() [m]
	Matrix3r repairStrain = Matrix3r::Zero(); // of the periodic cell, by repair [-]
	struct Overlap {						  // at the end of the step, without repair
		Real share = 0;						  // of the smaller radius, of half the thickness of the thinner block [-]
		Real depth = 0;						  // [m]
		int id1 = -1, id2 = -1;
	} worstOverlap; // by share, beyond deepOverlap; not of springs, nor of bodies that nothing moves apart
	static constexpr Real deepOverlap = 0.1;

	void collectBodies(Scene& scene, const IntegratorPlan& plan);
	/// @param warmStart  factor for the stored impulses: ratio of time steps, or 0 to start from nothing
	void collectContacts(const Scene& scene, const std::string& contactLaw, Real warmStart);
	/// After collectContacts(): recognises a two-dimensional scene, whose disks are solved as balls.
	void usePlane();
	/// After collectBodies(): the periodic cell has inertia and moves with the contacts. The velocities collected hold the gradient of the field.
	void useMeanField(const contactdynamics::MeanField& field, const IntegratorPlan& plan);
	contactdynamics::SolveReport solve(Real allowedResidual, int maxIterations, bool accelerated);
	/// After apply(): what the contacts sustain, Σ r ⊗ b over them (impulse on body 2, vector from mass centre 1 to 2) [N m s].
	Matrix3r moment() const;
	void apply(Scene& scene);
	/// After apply(): displaces bodies that overlap, see PenetrationRepair.
	/// @param rate     largest share of an overlap that is taken away [-], 0 ... 1; 0 only measures
	/// @param allowed  overlap that is left alone, in sizes of the contact [-], >= 0
	/// @param cellMobility  see PenetrationRepair::solve()
	void repairPenetration(Scene& scene, Real rate, Real allowed, const Matrix3r& cellMobility);

	std::vector<Twist> free() const; // velocities without contact by solver index
	std::vector<Twist> end() const;	 // likewise at the end of the step
	boost::python::list velocitiesById(const std::vector<Twist>& twists) const;
	boost::python::list angularMomentaById() const;
	boost::python::dict asDictionary() const;	   // see ContactDynamicsEngine.lastProblem
	boost::python::dict normsAsDictionary() const; // see ContactDynamicsEngine.convergenceNorms

private:
	/// What the contacts need of a body, looked up once a step instead of once a contact.
	struct BodyView {
		const State* state = nullptr; // null: erased
		Real radius = 0;			  // 0: no sphere [m]
		int index = -1;				  // into problem.bodies; that of the clump for a member
		bool member = false;		  // of a clump
		bool ball = false;			  // an impulse through the centre does not turn it, and all directions are alike
		bool fixed = false;			  // no impulse moves it
		bool belt = false;			  // nor its own velocity, see beltVelocity()
	};
	/// What links a contact of the problem with the scene. A pair of spheres enters the problem with the smaller id first, whatever order
	/// YADE chose: that order may differ after O.load, and with it the last bits.
	struct Link {
		Interaction* interaction;
		ContactDynamicsPhys* phys; // that of the point
		int point;				   // of a ManifoldGeom; -1 for a contact with one point
		int id1, id2;			   // of the bodies, as the interaction has them
		bool swapped = false, solved = true;
		bool plain = true; // see ContactDynamicsPhys::isPlain
		// From the positions of the two bodies (not of their clumps) to the contact point [m].
		Vector3r arm1 = Vector3r::Zero(), arm2 = Vector3r::Zero();
		Real gap = 0;			// [m]
		Real pseudoImpulse = 0; // that of phys: saves the repair from fetching phys to find it, or to leave it
	};
	struct Manifold { // contact with several points, each of which is a link
		ManifoldGeom* geom;
		ContactDynamicsManifoldPhys* phys;
		Interaction* interaction;
	};
	struct Gathered { // interaction, one of this law once they are in order
		Interaction* interaction;
		ContactDynamicsPhys* phys; // null: of another law, potential only, or of a body that is gone
		int id1, id2;
		int firstLink;
		bool severalPoints;
	};
	struct Load {
		Vector3r force, torque;
	};

	contactdynamics::SolveReport solveAtRest(const contactdynamics::SolverOptions& options);
	bool standsStill() const;
	Real roundOffAtRest() const;
	contactdynamics::BlockProblem assembledProblem(const char* caller) const;
	void gatherInteractions(const Scene& scene);
	void orderById();
	void settleSurfaceSeams(const Scene& scene);
	void settleBlockSeamsOf(const Scene& scene);
	void passOnImpulses(Link* const* group, const std::vector<SurfaceContact>& contacts) const;
	void describe(const Scene& scene, Link& link, contactdynamics::Contact& contact) const;
	bool movesApart(const contactdynamics::Contact& contact) const;
	Vector3r beltVelocity(const BodyView& view, const Vector3r& arm, const Vector3r& normal) const;
	Vector3r beltTurning(int index) const;
	void requireUsable(const Link& link, const contactdynamics::Contact& contact) const;
	bool forecast(const Link& link, const contactdynamics::Contact& contact) const;
	Twist atStart(int index) const;
	Twist freeOf(int index) const { return {motions[index].velocity, motions[index].angularVelocity}; }
	Vector3r relativeVelocity(const contactdynamics::Contact& contact, const Twist& of1, const Twist& of2) const;
	Vector3r velocityAtStart(const contactdynamics::Contact& contact) const;
	Vector3r shiftOf(const contactdynamics::Contact& contact) const;
	void shiftContacts(Real warmStart);
	void toMeanField();
	void fromMeanField();
	void trackEnergy(Scene& scene);
	Real powerOnPrescribed(int index, const Vector3r& force, const Vector3r& torque) const;
	void writeBack(const Link& link, const contactdynamics::Contact& contact) const;
	static void leaveOut(Link& link);
	/// What touches as one in the repair, where bodies are not turned: all points of an interaction.
	struct TouchingPair {
		std::size_t first, last; // links, last one excluded
		bool loaded;
		Real gap;	  // that is repaired, see gapToRepair() [m]
		Real deepest; // of all points [m]
		Real size;	  // what an overlap is measured against [m]
	};
	Real sizeOf(std::size_t contact) const;
	Real gapAfterMotion(std::size_t contact) const;
	Real gapToRepair(const TouchingPair& pair) const;
	TouchingPair pairFrom(std::size_t first) const;
	void noteOverlap(const Scene& scene, const TouchingPair& pair);
	void choosePairs(const Scene& scene);
	void setPseudoImpulse(const TouchingPair& pair, Real pseudoImpulse);
	void displace(Scene& scene, Real share, Real allowed, const Matrix3r& cellMobility);

	bool solved = false; // problem holds a solution
	Real h = 0;
	Real tolerance = 0; // of the last solve
	Vector3r gravity;
	Matrix3r velGrad;				 // that the integrator will apply, for the velocity of periodic images
	Matrix3r displacementAsVelocity; // see IntegratorPlan::velocityOfDisplacement [1/s]
	PenetrationRepair repair;
	std::vector<TouchingPair> pairs;					  // that the repair looks after
	std::vector<PenetrationRepair::Candidate> candidates; // parallel to them
	std::vector<BodyView> views;						  // by body id
	std::vector<int> idOfIndex;
	std::vector<FreeMotion> motions;		   // by solver index
	std::vector<Vector3r> places;			   // likewise, where there is a mean field: positions [m]
	std::optional<IntegratorPlan> planOfField; // where there is a mean field
	std::vector<Gathered> gathered;
	std::vector<int> firstOfId, byLargerId, byIds; // places in gathered, see orderById()
	std::vector<Link> links;					   // parallel to problem.contacts once collected
	std::vector<Manifold> manifolds;
	std::vector<Load> loads; // contact force and torque by body id
	ShiftedContacts shifted;
	std::vector<std::uint8_t> bonded; // by contact, while energy is tracked: a bond may break in the step
	contactdynamics::SignoriniCoulombSolver solver;
	std::vector<contactdynamics::Body> freeBodies; // of solveAtRest(), to start again from
	std::optional<contactdynamics::MeanField> freeField;
};

} // namespace yade
