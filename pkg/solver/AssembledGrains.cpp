// SPDX-License-Identifier: GPL-2.0-or-later
#include "AssembledGrains.hpp"

#include <Eigen/Geometry>
#include <map>

namespace contactdynamics {

namespace {

/// Contacts at each body that can move.
std::vector<std::vector<std::int32_t>> contactsByBody(const GrainProblem& problem)
{
	std::vector<std::vector<std::int32_t>> at(problem.bodies.size());
	for (std::size_t i = 0; i < problem.contacts.size(); ++i)
		for (const std::int32_t body : {problem.contacts[i].body1, problem.contacts[i].body2})
			if (problem.bodies[body].moves()) at[body].push_back(std::int32_t(i));
	return at;
}

template <class Rows> void append(std::vector<double>& values, const Rows& rows)
{
	for (int row = 0; row < rows.rows(); ++row)
		for (int column = 0; column < rows.cols(); ++column) values.push_back(rows(row, column));
}

/// The field at the solution: a component that stands at its bound responds to no impulse.
Matrix3 fieldMobility(const MeanField& field)
{
	const Matrix3 stretch = 0.5 * (field.gradient + field.gradient.transpose());
	return (stretch.array().abs() < field.limit).select(field.inverseMass, 0);
}

/// Velocity L b of a contact at impulses r of another one, both in the frames of the contacts: dL = sym(r b^T) / M.
Matrix3 throughField(const Matrix3& mobility, const Matrix3& frame, const Vector3& branch, const Matrix3& otherFrame, const Vector3& otherBranch)
{
	Matrix3 W;
	for (int k = 0; k < 3; ++k) {
		const Matrix3 moment = otherFrame.row(k).transpose() * otherBranch.transpose();
		W.col(k) = frame * (mobility.cwiseProduct(0.5 * (moment + moment.transpose())) * branch);
	}
	return W;
}

} // namespace

BlockProblem assembled(const GrainProblem& solved, const std::vector<Matrix3>& frames)
{
	const std::vector<std::vector<std::int32_t>> contactsAt = contactsByBody(solved);
	BlockProblem blocks;
	blocks.rowStart.push_back(0);
	std::map<std::int32_t, Matrix3> row;
	const Matrix3 mobility = solved.meanField ? fieldMobility(*solved.meanField) : Matrix3(Matrix3::Zero());
	for (std::size_t i = 0; i < solved.contacts.size(); ++i) {
		const Contact& contact = solved.contacts[i];
		row.clear();
		Matrix3& diagonal = row[std::int32_t(i)] = Matrix3::Zero();
		diagonal.diagonal() << contact.normalCompliance, contact.tangentialCompliance, contact.tangentialCompliance;
		const Vector3 compliance = diagonal.diagonal();
		for (const std::int32_t body : {contact.body1, contact.body2}) {
			const Body& own = solved.bodies[body];
			const bool is2 = body == contact.body2;
			const Vector3& arm = is2 ? contact.arm2 : contact.arm1;
			for (const std::int32_t j : contactsAt[body]) {
				const Contact& other = solved.contacts[j];
				const bool other2 = body == other.body2;
				Matrix3& W = row.emplace(j, Matrix3::Zero()).first->second;
				for (int k = 0; k < 3; ++k) { // velocity at contact i from a unit impulse along axis k of contact j
					const Vector3 push = (is2 == other2 ? 1 : -1) * frames[j].row(k).transpose();
					const Vector3 turned = own.inverseInertia * (other2 ? other.arm2 : other.arm1).cross(push);
					W.col(k) += frames[i] * (own.inverseMass.cwiseProduct(push) + turned.cross(arm));
				}
			}
		}
		if (!mobility.isZero(0))
			for (std::size_t j = 0; j < solved.contacts.size(); ++j) {
				const Contact& other = solved.contacts[j];
				row.emplace(std::int32_t(j), Matrix3::Zero()).first->second +=
						throughField(mobility, frames[i], contact.arm1 - contact.arm2, frames[j], other.arm1 - other.arm2);
			}
		const Vector3 r = frames[i] * contact.impulse;
		const Vector3 u = frames[i] * contact.relativeVelocity + Vector3(contact.gapVelocity, 0, 0) + compliance.cwiseProduct(r);
		Vector3 q = u;
		for (const auto& [j, W] : row) {
			q -= W * (frames[j] * solved.contacts[j].impulse);
			blocks.column.push_back(j);
			append(blocks.blocks, W);
		}
		blocks.rowStart.push_back(std::int32_t(blocks.column.size()));
		append(blocks.q, q);
		append(blocks.velocity, u);
		append(blocks.impulse, r);
		blocks.friction.push_back(contact.friction);
	}
	return blocks;
}

} // namespace contactdynamics
