// SPDX-License-Identifier: GPL-2.0-or-later
#include "RefusedInteraction.hpp"
#include "DeferredError.hpp"
#include <core/Dispatching.hpp>
#include <core/Interaction.hpp>

namespace yade {
namespace {
/// Not registered with YADE: it exists only in the functor cache of refused interactions, which is never saved.
class RefusingLaw : public LawFunctor {
public:
	bool go(shared_ptr<IGeom>&, shared_ptr<IPhys>&, Interaction*) override { return false; }
};
} // namespace

void refuseInteraction(const Scene* scene, Interaction& interaction, const std::string& message)
{
	DeferredError::report(scene, interaction.getId1(), interaction.getId2(), message);
	interaction.functorCache.constLaw = boost::shared_ptr<LawFunctor>(new RefusingLaw);
}

} // namespace yade
