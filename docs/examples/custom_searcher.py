"""A searcher of one's own in place of ``action_searcher``: depth first, large blocks first."""

from functools import partial

import rclpy.node
from blocks_planning_msgs import msg

from blocks_planning.ros.runtime import process
from blocks_planning.ros.wire import qos

LATCHED = {'trial': msg.TrialSpec, 'state': msg.WorldState, 'subgoal': msg.Subgoal}
LATCHED |= {'hold': msg.Hold}


class MySearcher(rclpy.node.Node):
    """Fills targets, and orders the placements of the subgoal that was chosen."""

    def __init__(self):
        super().__init__('my_searcher')
        self.latest = {name: kind() for name, kind in LATCHED.items()}
        self.result = self.create_publisher(msg.SearchResult, 'search/result', qos.stream())
        self.action = self.create_publisher(msg.PlaceBlock, 'action', qos.stream())
        for name, kind in LATCHED.items():
            keep = partial(self.keep, name)
            self.create_subscription(kind, name, keep, qos.every_latched_state())
        self.create_subscription(msg.SearchRequest, 'search/request', self.search, qos.stream())

    def keep(self, name, message):
        """Keep the latest message of a topic, and act on it."""
        self.latest[name] = message
        self.act(**self.latest)

    def search(self, asked):
        """Answer each query of a request."""
        for query in asked.queries:
            self.answer(asked.trial_id, query)

    def answer(self, trial_id, query):
        """Answer what filling a target takes; cells are (row, column) here."""
        self.seen, width = set(), query.target.width
        built, target = (
            {divmod(index, width) for index, cell in enumerate(grid.cells) if cell}
            for grid in (query.built, query.target)
        )
        plan = self.fill(frozenset(built), target)
        answer = msg.SearchResult(trial_id=trial_id, query=query)
        answer.status = 'unsolvable_proven' if plan is None else 'solved'
        answer.placements, answer.attempts = plan or [], 1
        answer.planning_cost = len(self.seen)
        answer.solution_cost = 0 if plan is None else answer.planning_cost
        self.result.publish(answer)

    def fill(self, built, target):
        """Return placements that fill a target, or None."""
        if built == target or built in self.seen:
            return [] if built == target else None
        self.seen.add(built)
        row, left = min(target - built)  # the lowest empty cell: nothing may cover it later
        library = self.latest['trial'].library
        for block in sorted(library, key=lambda block: -block.width * block.height):
            cells = {(row + y, left + x) for y in range(block.height) for x in range(block.width)}
            rests = row == 0 or any((row - 1, c) in built for _, c in cells)
            if rests and cells <= target - built:
                rest = self.fill(built | cells, target)
                if rest is not None:
                    return [msg.Placement(block=block, column=left, row=row), *rest]
        return None

    def act(self, trial, state, subgoal, hold):
        """Order the next placement. This holds in a world that carries out every order."""
        if not trial.trial_id == state.trial_id == subgoal.trial_id or not subgoal.decisions:
            return
        latest, done = subgoal.decisions[-1], state.sequence - subgoal.sequence
        held = hold.trial_id == trial.trial_id and hold.is_held and hold.sequence <= state.sequence
        chosen = latest.subgoals[latest.executed - 1] if latest.subgoals else None
        if chosen and 0 <= done < chosen.execute and not held:
            action = msg.PlaceBlock(trial_id=state.trial_id, sequence=state.sequence)
            action.block = chosen.placements[done].block
            action.column = chosen.placements[done].column
            self.action.publish(action)


if __name__ == '__main__':
    process.run(lambda _: MySearcher())
