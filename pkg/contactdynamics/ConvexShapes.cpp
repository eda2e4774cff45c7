// SPDX-License-Identifier: GPL-2.0-or-later
#include "ConvexShapes.hpp"
#include <pkg/common/Box.hpp>
#include <pkg/common/Facet.hpp>
#include <pkg/polyhedra/Polyhedra.hpp>
#include <boost/weak_ptr.hpp>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

namespace yade {
namespace {
struct Entry {
	boost::weak_ptr<Shape> owner;
	std::vector<Vector3r> from; // what the shape was worked out from
	std::unique_ptr<contactdynamics::ConvexShape> shape;
};
std::unordered_map<const Shape*, Entry> knownShapes;
std::shared_mutex knownShapesGuard;

/// The data of a shape as vectors, without a copy.
struct Source {
	const Vector3r* first = nullptr;
	std::size_t count = 0;
	enum { polyhedron, box, facet } kind = polyhedron;

	explicit Source(const Shape& shape)
	{
		if (const auto* polyhedra = dynamic_cast<const Polyhedra*>(&shape)) {
			first = polyhedra->v.data();
			count = polyhedra->v.size();
		} else if (const auto* cuboid = dynamic_cast<const Box*>(&shape)) {
			first = &cuboid->extents;
			count = 1;
			kind = box;
		} else if (const auto* triangle = dynamic_cast<const Facet*>(&shape)) {
			first = triangle->vertices.data();
			count = triangle->vertices.size();
			kind = facet;
		} else
			throw std::logic_error("ConvexShapes::of is not for " + shape.getClassName());
	}
	bool equals(const std::vector<Vector3r>& from) const { return from.size() == count && std::equal(from.begin(), from.end(), first); }
};

/// A box without thickness, as walls often are, is a plate.
contactdynamics::ConvexShape boxOrPlate(const Vector3r& half)
{
	if (!(half.allFinite() && half.minCoeff() >= 0 && (half.array() == 0).count() <= 1)) {
		std::ostringstream message;
		message << "half edges are " << half.transpose() << ", must be finite and positive, but one may be zero";
		throw std::invalid_argument(message.str());
	}
	int flat = 0;
	if (half.minCoeff(&flat) > 0) return contactdynamics::cuboid(half);
	const Vector3r along = half[(flat + 1) % 3] * Vector3r::Unit((flat + 1) % 3), across = half[(flat + 2) % 3] * Vector3r::Unit((flat + 2) % 3);
	return contactdynamics::plate({-along - across, along - across, along + across, across - along});
}

contactdynamics::ConvexShape make(const Source& source)
{
	const char* attribute = source.kind == Source::polyhedron ? "Polyhedra.v: " : source.kind == Source::box ? "Box.extents: " : "Facet.vertices: ";
	try {
		if (source.kind == Source::box) return boxOrPlate(*source.first);
		const std::vector<Vector3r> points(source.first, source.first + source.count);
		if (source.kind == Source::facet && source.count != 3) throw std::invalid_argument("a facet needs three vertices");
		return source.kind == Source::facet ? contactdynamics::plate(points) : contactdynamics::convexHull(points);
	} catch (const std::invalid_argument& error) {
		throw std::invalid_argument(attribute + std::string(error.what()));
	}
}

/// Shapes that are gone make room when the table would grow.
void forgetTheDead()
{
	if (knownShapes.size() < static_cast<std::size_t>(knownShapes.max_load_factor() * static_cast<float>(knownShapes.bucket_count()))) return;
	for (auto entry = knownShapes.begin(); entry != knownShapes.end();)
		entry = entry->second.owner.expired() ? knownShapes.erase(entry) : std::next(entry);
}
} // namespace

const contactdynamics::ConvexShape& ConvexShapes::of(const shared_ptr<Shape>& shape)
{
	const Source source(*shape);
	{
		const std::shared_lock<std::shared_mutex> reading(knownShapesGuard);
		const auto found = knownShapes.find(shape.get());
		if (found != knownShapes.end() && !found->second.owner.expired() && source.equals(found->second.from)) return *found->second.shape;
	}
	auto made = std::make_unique<contactdynamics::ConvexShape>(make(source));
	const std::lock_guard<std::shared_mutex> writing(knownShapesGuard);
	const auto found = knownShapes.find(shape.get()); // another thread may have been faster, and its result may be in use
	if (found != knownShapes.end() && source.equals(found->second.from)) {
		found->second.owner = shape; // it may be of a shape that is gone and had the same address and the same vertices
		return *found->second.shape;
	}
	if (found == knownShapes.end()) forgetTheDead();
	Entry& entry = knownShapes[shape.get()];
	entry = {shape, std::vector<Vector3r>(source.first, source.first + source.count), std::move(made)};
	return *entry.shape;
}

} // namespace yade
