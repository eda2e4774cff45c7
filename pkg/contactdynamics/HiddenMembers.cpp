// SPDX-License-Identifier: GPL-2.0-or-later

#include "HiddenMembers.hpp"
#include "SafeRead.hpp"

#include <core/Clump.hpp>
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Facet.hpp>
#include <pkg/dem/ScGeom.hpp>

#include <memory>

namespace py = boost::python;

namespace yade {
namespace {

class Comparison {
	py::list& disagreements;

public:
	explicit Comparison(py::list& disagreements) : disagreements(disagreements) {}
	/// `found` is what Python, or YADE's own code, says; `ours` what this library reads.
	template <class Value> bool same(const char* member, const Value& found, const Value& ours)
	{
		const bool agree = found == ours;
		if (!agree) disagreements.append(string(member) + ": YADE has " + inWords(found) + ", read here as " + inWords(ours));
		return agree;
	}

private:
	template <class Value> static string inWords(const Value& value) { return py::extract<string>(py::str(py::object(value)))(); }
};

void compareState(Comparison& compare, const py::object& wrapper)
{
	py::object python = wrapper.attr("State")();
	const State& state = py::extract<const State&>(python)();
	const Vector3r position = Vector3r(1, 2, 3);
	const Quaternionr orientation = Quaternionr(AngleAxisr(.5, Vector3r::UnitX()));
	python.attr("pos") = position;
	python.attr("ori") = orientation;
	python.attr("blockedDOFs") = "xZ";
	compare.same("State.se3.position", position, state.se3.position);
	compare.same("State.se3.orientation", orientation, state.se3.orientation);
	compare.same("address of State.pos", reinterpret_cast<long>(&state.se3.position), reinterpret_cast<long>(&state.pos));
	compare.same("address of State.ori", reinterpret_cast<long>(&state.se3.orientation), reinterpret_cast<long>(&state.ori));
	compare.same("State.blockedDOFs", int(State::DOF_X | State::DOF_RZ), int(state.blockedDOFs));
}

void compareCell(Comparison& compare, const py::object& wrapper)
{
	py::object python = wrapper.attr("Cell")();
	const Cell& cell = py::extract<const Cell&>(python)();
	Matrix3r edges = Vector3r(2, 3, 4).asDiagonal();
	Matrix3r velocityGradient = Matrix3r::Zero();
	edges(0, 1) = .5;
	velocityGradient(0, 1) = .125;
	python.attr("hSize") = edges;
	// The constructor's keywords and updateAttrs set the member itself, and not what it becomes in the next step.
	py::dict attributes;
	attributes["velGrad"] = velocityGradient;
	python.attr("updateAttrs")(attributes);

	const Vector3r point(.1, .2, .3);
	compare.same("Cell.hSize", edges, cell.hSize);
	compare.same("Cell.velGrad", velocityGradient, cell.velGrad);
	compare.same("Cell.size", Vector3r(py::extract<Vector3r>(python.attr("size"))), cell.getSize());
	compare.same("Cell.shearPt", Vector3r(py::extract<Vector3r>(python.attr("shearPt")(point))), cell.shearPt(point));
	compare.same("Cell.unshearPt", Vector3r(py::extract<Vector3r>(python.attr("unshearPt")(point))), cell.unshearPt(point));
	compare.same("Cell.hasShear", true, cell.hasShear());
	compare.same("Cell.intrShiftVel", Vector3r(velocityGradient * cell.prevHSize.col(1)), cell.intrShiftVel(Vector3i(0, 1, 0)));
}

void compareContactAndFacet(Comparison& compare, const py::object& wrapper)
{
	const py::object pythonGeom = wrapper.attr("ScGeom")();
	const ScGeom& geom = py::extract<const ScGeom&>(pythonGeom)();
	compare.same("address of ScGeom.radius1", reinterpret_cast<long>(&geom.refR1), reinterpret_cast<long>(&geom.radius1));
	compare.same("address of ScGeom.radius2", reinterpret_cast<long>(&geom.refR2), reinterpret_cast<long>(&geom.radius2));

	py::object pythonFacet = wrapper.attr("Facet")();
	py::list vertices;
	vertices.append(Vector3r(3, 0, 0));
	vertices.append(Vector3r(0, 4, 0));
	vertices.append(Vector3r(0, 0, 0));
	pythonFacet.attr("vertices") = vertices;
	const Facet& facet = py::extract<const Facet&>(pythonFacet)();
	compare.same("Facet.vl", Real(4), facet.vl[1]);
	compare.same("Facet.vu", Vector3r(1, 0, 0), facet.vu[0]);
}

/// Whether a pointer of the scene leads to an object of the class it should lead to, told by its table of virtual functions. Does not follow the
/// pointer before it is known to lead to memory.
bool leadsTo(const char* className, const void* object)
{
	const std::unique_ptr<Factorable> other(ClassFactory::instance().createPure(className));
	const auto found = safelyRead<const void*>(object);
	const auto expected = safelyRead<const void*>(dynamic_cast<const void*>(other.get()));
	return found && expected && *found == *expected;
}

void compareScene(Comparison& compare)
{
	const py::object O = py::import("yade.wrapper").attr("Omega")();
	const Scene& scene = *Omega::instance().getScene();
	const Scene& python = py::extract<const Scene&>(O.attr("_sceneObj"))();
	if (!compare.same("address of the scene", reinterpret_cast<long>(&python), reinterpret_cast<long>(&scene))) return;

	const EnergyTracker& energy = py::extract<const EnergyTracker&>(O.attr("energy"))();
	compare.same("address of Scene.energy", reinterpret_cast<long>(&energy), reinterpret_cast<long>(scene.energy.get()));
	compare.same("Scene.cell leads to a Cell", true, leadsTo("Cell", scene.cell.get()));
	if (compare.same("Scene.bodies leads to a BodyContainer", true, leadsTo("BodyContainer", scene.bodies.get())))
		compare.same("number of bodies", long(py::len(O.attr("bodies"))), long(scene.bodies->size()));
	if (compare.same("Scene.interactions leads to an InteractionContainer", true, leadsTo("InteractionContainer", scene.interactions.get())))
		compare.same("number of interactions", long(py::len(O.attr("interactions"))), long(scene.interactions->size()));
	compare.same("number of materials", long(py::len(O.attr("materials"))), long(scene.materials.size()));
}

} // namespace

void compareHiddenMembers(py::list& disagreements)
{
	const py::object wrapper = py::import("yade.wrapper");
	Comparison compare(disagreements);
	compareState(compare, wrapper);
	compareCell(compare, wrapper);
	compareContactAndFacet(compare, wrapper);
	compareScene(compare);
}

} // namespace yade
