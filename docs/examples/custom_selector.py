"""A selector of one's own, strategy external: one layer after the other, from the ground."""

from functools import partial

import rclpy.node
from blocks_planning_msgs import msg

from blocks_planning.ros.runtime import process
from blocks_planning.ros.wire import qos

LATCHED = {'trial': msg.TrialSpec, 'state': msg.WorldState}


class MySelector(rclpy.node.Node):
    """Decides in every state in which the last subgoal is reached."""

    def __init__(self):
        super().__init__('my_selector')
        self.trial, self.state = msg.TrialSpec(), msg.WorldState()
        self.decisions, self.query = [], None
        self.subgoal = self.create_publisher(msg.Subgoal, 'subgoal', qos.latched_state())
        self.request = self.create_publisher(msg.SearchRequest, 'search/request', qos.stream())
        for name, kind in LATCHED.items():
            keep = partial(self.keep, name)
            self.create_subscription(kind, name, keep, qos.every_latched_state())
        self.create_subscription(msg.SearchResult, 'search/result', self.decide, qos.stream())
        self.create_timer(1.0, self.ask)  # again: a searcher may start late

    def keep(self, name, message):
        """Keep the latest trial or state, and ask what the next layer takes."""
        if name == 'trial' and message.trial_id != self.trial.trial_id:
            self.decisions = []
        setattr(self, name, message)
        self.ask()

    def ask(self):
        """Ask the searcher for the next layer, if a decision is due."""
        trial, state = self.trial, self.state
        if trial.planner.strategy != 'external' or trial.trial_id != state.trial_id:
            return
        last = self.decisions[-1].subgoals if self.decisions else None
        reached = not last or last[0].target == state.built
        if state.status != 'building' or last == [] or not reached:
            return
        cells, built = trial.silhouette.cells, state.built.cells
        width, first = trial.silhouette.width, next(i for i, c in enumerate(cells) if c > built[i])
        self.height = first // width + 1
        layer = [cell and row // width < self.height for row, cell in enumerate(cells)]
        target = msg.Grid(width=width, height=trial.silhouette.height, cells=layer)
        self.query = msg.Query(built=state.built, target=target)
        self.request.publish(msg.SearchRequest(trial_id=trial.trial_id, queries=[self.query]))

    def decide(self, found):
        """Choose the layer if it can be filled; otherwise give up."""
        if found.trial_id != self.trial.trial_id or found.query != self.query:
            return
        self.query, solved = None, found.status == 'solved'
        built, target = found.query.built, found.query.target
        decision = msg.Decision(sequence=self.state.sequence, built=built, sequences=1)
        decision.regions = [msg.Region(label_kind='rows', label_numbers=[self.height])]
        decision.regions[0].cells = target
        candidate = msg.Candidate(regions=[0], cells=sum(target.cells) - sum(built.cells))
        candidate.status, candidate.planning_cost = found.status, found.planning_cost
        decision.candidates, decision.chosen = [candidate], 0 if solved else -1
        decision.subgoal_planning_cost, decision.executed = found.planning_cost, int(solved)
        if solved:
            plan = msg.PlannedSubgoal(target=target, placements=found.placements)
            plan.execute, plan.attempts = len(plan.placements), found.attempts
            plan.planning_cost, plan.solution_cost = found.planning_cost, found.solution_cost
            decision.subgoals = [plan]
        self.decisions.append(decision)
        chosen = msg.Subgoal(trial_id=found.trial_id, sequence=decision.sequence)
        chosen.status = 'chosen' if solved else 'none_solvable'
        chosen.decisions = self.decisions
        self.subgoal.publish(chosen)


if __name__ == '__main__':
    process.run(lambda _: MySelector())
