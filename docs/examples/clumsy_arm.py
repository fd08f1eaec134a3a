"""An arm that serves ``place``: it slips, loses a block, or makes the tower topple."""

import rclpy.node
from blocks_planning_msgs import msg
from blocks_planning_msgs.action import Place
from rclpy.action.server import ActionServer, CancelResponse

from blocks_planning.ros.runtime import process

CODES = msg.PlacementOutcome


class ClumsyArm(rclpy.node.Node):
    """Each parameter is the number of the order, from 1, at which that happens; 0 is never."""

    def __init__(self, **options):
        super().__init__('clumsy_arm', **options)
        names = ('slips_at', 'loses_at', 'topples_at')
        self.at = {name: self.declare_parameter(name, 0).value for name in names}
        self.trial, self.orders, self.stands = '', 0, []
        self.last, self.result = None, None
        self.server = ActionServer(
            self, Place, 'place', self.place, cancel_callback=lambda _: CancelResponse.ACCEPT
        )

    def place(self, goal):
        """Carry out an order; one that is asked for again has been carried out."""
        order = goal.request
        if order.trial_id != self.trial:
            self.trial, self.orders, self.stands = order.trial_id, 0, []
        if (order.trial_id, order.sequence) != self.last:
            self.last = order.trial_id, order.sequence
            goal.publish_feedback(Place.Feedback(phase='lower', progress=0.5))
            self.orders += 1
            self.result = self.act(order.placement)
        goal.succeed()
        return self.result

    def act(self, wanted):
        """Place a block, more or less; report what is there afterwards that was not before."""
        if self.orders == self.at['topples_at']:
            fallen, self.stands = self.stands, []
            return Place.Result(code=CODES.CODE_COLLAPSED, reason='an elbow', gone=fallen)
        if self.orders == self.at['loses_at']:
            return Place.Result(code=CODES.CODE_LOST, reason='the block fell off the table')
        slips = self.orders == self.at['slips_at']
        column = wanted.column + (1 if wanted.column == 0 else -1) * slips
        covered = range(column, column + wanted.block.width)
        tops = [b.row + b.block.height for b in self.stands if set(covered) & set(columns(b))]
        landed = msg.Placement(block=wanted.block, column=column, row=max(tops, default=0))
        self.stands.append(landed)
        code = CODES.CODE_SLIPPED if slips else CODES.CODE_PLACED
        return Place.Result(code=code, landed=[landed])


def columns(block):
    """The columns that a block covers."""
    return range(block.column, block.column + block.block.width)


if __name__ == '__main__':
    process.run(lambda _: ClumsyArm())
