"""A robot in place of ``world``: it takes its time, and tells what its camera sees."""

import rclpy.node
from blocks_planning_msgs import msg

from blocks_planning.ros.runtime import process
from blocks_planning.ros.wire import qos


class FakeRobot(rclpy.node.Node):
    """Drops one block at a time, some milliseconds after it was told to."""

    def __init__(self):
        super().__init__('fake_robot')
        self.outcome = self.create_publisher(msg.PlacementOutcome, 'action/outcome', qos.stream())
        self.state = self.create_publisher(msg.WorldState, 'state', qos.latched_state())
        self.create_subscription(msg.TrialSpec, 'trial', self.begin, qos.every_latched_state())
        self.create_subscription(msg.PlaceBlock, 'action', self.place, qos.stream())
        self.create_timer(0.005, self.move)
        self.trial, self.order, self.placements = None, None, []

    def begin(self, trial):
        """Clear the table for a trial; it may be announced again while it runs."""
        if self.trial is None or self.trial.trial_id != trial.trial_id:
            self.trial, self.order, self.placements = trial, None, []
        self.look()

    def place(self, order):
        """Take note of what to do."""
        if self.trial and order.trial_id == self.trial.trial_id:
            self.order = order

    def move(self):
        """Do it, if it refers to the board as it is."""
        order, self.order = self.order, None
        if order is None or order.sequence != len(self.placements):
            return
        covered = range(order.column, order.column + order.block.width)
        row = max((r + 1 for r, c in self.cells() if c in covered), default=0)
        placed = msg.Placement(block=order.block, column=order.column, row=row)
        self.placements.append(placed)
        outcome = msg.PlacementOutcome(trial_id=order.trial_id, sequence=order.sequence)
        outcome.status, outcome.placed = 'placed', placed
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
        """Tell what there is to see."""
        grid, filled = self.trial.silhouette, self.cells()
        cells = [int(divmod(index, grid.width) in filled) for index in range(len(grid.cells))]
        seen = msg.WorldState(trial_id=self.trial.trial_id, sequence=len(self.placements))
        seen.placements = list(self.placements)
        seen.built = msg.Grid(width=grid.width, height=grid.height, cells=cells)
        seen.status = 'success' if cells == list(grid.cells) else 'building'
        self.state.publish(seen)


if __name__ == '__main__':
    process.run(lambda _: FakeRobot())
