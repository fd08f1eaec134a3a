"""A robot in place of ``world``: it takes its time, and tells what its camera sees."""

import rclpy.node
from blocks_planning_msgs import msg

from blocks_planning.ros.runtime import process
from blocks_planning.ros.wire import qos


class FakeRobot(rclpy.node.Node):
    """Drops one block at a time, some milliseconds after it was ordered."""

    def __init__(self):
        super().__init__('fake_robot')
        self.outcome = self.create_publisher(msg.PlacementOutcome, 'action/outcome', qos.stream())
        self.state = self.create_publisher(msg.WorldState, 'state', qos.latched_state())
        self.create_subscription(msg.TrialSpec, 'trial', self.begin, qos.every_latched_state())
        self.create_subscription(msg.PlaceBlock, 'action', self.place, qos.stream())
        self.create_timer(0.005, self.move)
        self.trial, self.order = None, None
        self.seen, self.placements = [], []

    def begin(self, trial):
        """Start a trial from the blocks that stand; it may be announced again while it runs."""
        if self.trial is None or self.trial.trial_id != trial.trial_id:
            self.trial, self.order = trial, None
            self.placements = list(trial.built)
            self.seen = [msg.Observation(landed=trial.built)]  # observation 0: as it was found
        self.look()

    def place(self, order):
        """Keep an order; only one that refers to the latest observation is carried out."""
        if self.trial and order.trial_id == self.trial.trial_id:
            self.order = order

    def move(self):
        """Carry out the order."""
        order, self.order = self.order, None
        if order is None or order.sequence != len(self.seen) - 1:
            return
        covered = range(order.column, order.column + order.block.width)
        row = max((r + 1 for r, c in self.cells() if c in covered), default=0)
        landed = msg.Placement(block=order.block, column=order.column, row=row)
        self.placements.append(landed)
        observation = msg.Observation(has_order=True, landed=[landed])  # nothing: landed=[]
        observation.ordered_block, observation.ordered_column = order.block, order.column
        self.seen.append(observation)
        outcome = msg.PlacementOutcome(trial_id=order.trial_id, sequence=order.sequence)
        outcome.code, outcome.placed = msg.PlacementOutcome.CODE_PLACED, landed
        self.outcome.publish(outcome)
        self.look()

    def cells(self):
        """Return the filled cells as (row, column)."""
        filled = set()
        for p in self.placements:
            rows, columns = range(p.row, p.row + p.block.height), range(p.block.width)
            filled |= {(row, p.column + column) for row in rows for column in columns}
        return filled

    def look(self):
        """Publish what there is to see, with all that was seen before."""
        grid, filled = self.trial.silhouette, self.cells()
        cells = [int(divmod(index, grid.width) in filled) for index in range(len(grid.cells))]
        state = msg.WorldState(trial_id=self.trial.trial_id, sequence=len(self.seen) - 1)
        state.observations, state.placements = list(self.seen), list(self.placements)
        state.built = msg.Grid(width=grid.width, height=grid.height, cells=cells)
        state.status = 'success' if cells == list(grid.cells) else 'building'
        self.state.publish(state)


if __name__ == '__main__':
    process.run(lambda _: FakeRobot())
