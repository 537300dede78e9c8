"""Networks of one's own: some that are right, and others that are wrong in one way each.

A line that ends with the name of a network is where that one fails.
"""

import torch
from torch import nn
from galactic.learning.encoders import Encoder, Eyes, StateEncoder, images
from galactic.learning.sequences import run_gru


class Net(Encoder):
    features = 8

    def __init__(self, seen):
        super().__init__()
        self.layer = nn.Linear(seen.state, 8)

    def forward(self, inputs):
        return self.layer(inputs.state)


class Narrow(Net):
    features = 9


class Nameless(Net):
    features = 0


class Flat(Net):
    def forward(self, inputs):
        return self.layer(inputs.state).sum(-1)


class Nothing(Net):
    def forward(self, inputs):
        pass


class Misfit(Net):
    def forward(self, inputs):
        return self.layer(inputs.state[..., 1:])  # Misfit


class Blind(Net):
    def forward(self, inputs):
        return self.layer(inputs.state) + inputs.depth.mean()  # Blind


class Unmade(Net):
    def __init__(self, seen):
        raise KeyError("no such part")  # Unmade


class Ends(Net):
    def __init__(self, seen):
        raise SystemExit(0)


class NaNs(Net):
    def forward(self, inputs):
        return self.layer(inputs.state) / 0.0 * 0.0


class Wide(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.scale = nn.Parameter(torch.ones(8, dtype=torch.float64))


class Drops(Net):
    def forward(self, inputs):
        return nn.functional.dropout(self.layer(inputs.state), 0.5, self.training)


class Remembers(Net):
    memory = 4

    def forward(self, inputs, memory, starts):
        return self.layer(inputs.state) + memory.sum(), memory


class Forgets(Remembers):
    def forward(self, inputs, memory, starts):
        return self.layer(inputs.state)


class Short(Remembers):
    def forward(self, inputs, memory, starts):
        return self.layer(inputs.state), memory[..., 1:]


class Formless(Encoder):
    features = 8


class Looks(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.features = 8 + seen.state
        self.eyes = Eyes(
            nn.Sequential(
                nn.Conv2d(seen.channels, 4, 8, 8), nn.ReLU(), nn.Flatten(), nn.Linear(4 * 4 * 4, 8)
            )
        )

    def forward(self, inputs):
        return torch.cat([self.eyes(inputs), inputs.state], -1)


class Stacks(Net):
    """Looks at the channels of a picture as layers of a volume."""

    def __init__(self, seen):
        super().__init__(seen)
        self.features = 8 + seen.state
        self.layers = nn.Sequential(
            nn.Conv3d(1, 4, (seen.channels, 8, 8), 8),
            nn.ReLU(),
            nn.Flatten(),
            nn.Linear(4 * 4 * 4, 8),
        )

    def forward(self, inputs):
        steps, envs = inputs.state.shape[:2]
        volumes = images(inputs).unsqueeze(1)
        return torch.cat([self.layers(volumes).view(steps, envs, 8), inputs.state], -1)


class Sines(Net):
    def forward(self, inputs):
        return torch.sin(self.layer(inputs.state))


class Branches(Net):
    def forward(self, inputs):
        return self.layer(inputs.state) if inputs.state.sum() > 0 else self.layer(-inputs.state)


class Sums(Net):
    features = 12

    def forward(self, inputs):
        x = self.layer(inputs.state)
        return torch.cat([torch.relu(x) + torch.tanh(x), x[..., 2:6]], -1)


class Doubled(nn.Conv2d):
    def forward(self, x):
        return 2.0 * super().forward(x)


class Weighted(nn.Conv2d):
    def _conv_forward(self, x, weight, bias):
        return super()._conv_forward(x, 2.0 * weight, bias)


class Backwards(nn.Sequential):
    def forward(self, x):
        return -super().forward(x)


class Patch(nn.Sequential):
    def __init__(self, first):
        super().__init__(first, nn.ReLU(inplace=True), nn.Flatten(), nn.Linear(4 * 4 * 4, 8))


class LooksTwice(Looks):
    def __init__(self, seen, doubled=True):
        super().__init__(seen)
        first = (Doubled if doubled else Weighted)(seen.channels, 4, 8, 8)
        self.eyes = Eyes(Patch(first))


class LooksBack(Looks):
    def __init__(self, seen):
        super().__init__(seen)
        self.eyes = Eyes(Backwards(*self.eyes.layers))


class LooksPlainly(Looks):
    def __init__(self, seen):
        super().__init__(seen)
        self.eyes = Eyes(Patch(nn.Conv2d(seen.channels, 4, 8, 8)))


class Halved(StateEncoder):
    def __init__(self, seen, width=8):
        super().__init__(seen.state, width, 1, "tanh")

    def forward(self, inputs):
        return torch.cat([super().forward(inputs)[..., 0:4], inputs.state[..., 0:4]], -1)


class Perceptron(StateEncoder):
    def __init__(self, seen):
        super().__init__(seen.state, 8, 1, "tanh")


class InPlace(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.relu = nn.ReLU(inplace=True)

    def forward(self, inputs):
        x = self.layer(inputs.state)
        return self.relu(x) + x


class InPlaceToo(Net):
    def forward(self, inputs):
        x = self.layer(inputs.state)
        return nn.functional.relu(x, inplace=True) + x


class OfASlice(Net):
    features = 6

    def forward(self, inputs):
        x = self.layer(inputs.state)
        nn.functional.relu(x[..., 0:6], True)
        return x[..., 0:6]


class BehindAView(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.flat = nn.Flatten(2)
        self.relu = nn.ReLU(inplace=True)

    def forward(self, inputs):
        x = self.layer(inputs.state)
        return self.relu(self.flat(x)) + x


class WeightNormed(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.layer = nn.utils.weight_norm(self.layer)


class Parametrized(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.layer = nn.utils.parametrizations.orthogonal(self.layer)


class Replaced(Net):
    def __init__(self, seen):
        super().__init__(seen)
        forward = self.layer.forward
        self.layer.forward = lambda x: 2.0 * forward(x)


class MixesSteps(Net):
    def forward(self, inputs):
        x = self.layer(inputs.state)
        return x - x.mean(0, keepdim=True)


class MixesEnvs(Net):
    def forward(self, inputs):
        x = self.layer(inputs.state)
        return x - x.mean(1, keepdim=True)


class MixesAll(Net):
    def forward(self, inputs):
        return self.layer(inputs.state) / inputs.state.norm()


class MixesImages(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.eyes = Eyes(nn.Sequential(nn.Conv2d(seen.channels, 8, 36), nn.Flatten()))

    def forward(self, inputs):
        return self.eyes(inputs) / inputs.rgb.float().std()


class OneEnvAlone(Net):
    def forward(self, inputs):
        return self.layer(inputs.state).squeeze(1)


class Averages(Net):
    # The mean of all that it has seen of an episode: a memory of how many steps, and of their sum.
    memory = 9
    resets = True

    def forward(self, inputs, memory, starts):
        features = []
        for seen, begun in zip(self.layer(inputs.state), starts):
            kept = memory * (~begun).unsqueeze(-1) if self.resets or not features else memory
            memory = torch.cat([kept[:, :1] + 1.0, kept[:, 1:] + seen], -1)
            features.append(memory[:, 1:] / memory[:, :1])
        return torch.stack(features), memory


class EmptiedAtFirst(Averages):
    resets = False


class LosesSteps(Averages):
    def forward(self, inputs, memory, starts):
        features, _ = super().forward(inputs, memory, starts)
        return features, torch.zeros_like(memory)


class Recalls(Net):
    # Its features are what its memory makes of them.
    memory = 8

    def __init__(self, seen):
        super().__init__(seen)
        self.rnn = nn.GRU(8, 8)

    def forward(self, inputs, memory, starts):
        return run_gru(self.rnn, torch.tanh(self.layer(inputs.state)), memory, starts)


class RecallsBeside(Recalls):
    def forward(self, inputs, memory, starts):
        recalled, memory = super().forward(inputs, memory, starts)
        return torch.relu(recalled + self.layer(inputs.state)), memory


class Attends(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.attention = nn.MultiheadAttention(8, 2, batch_first=True)

    def forward(self, inputs):
        x = self.layer(inputs.state).unsqueeze(-2)
        shape, x = x.shape, x.flatten(0, 1)
        return self.attention(x, x, x, need_weights=False)[0].view(*shape[:2], -1)  # Attends


class Unrolls(Net):
    def forward(self, inputs):
        return torch.stack([self.layer(one) for one in inputs.state])  # Unrolls


class Bilinear(Net):
    def __init__(self, seen):
        super().__init__(seen)
        self.both = nn.Bilinear(seen.state, 8, 8)

    def forward(self, inputs):
        return self.both(inputs.state, self.layer(inputs.state))  # Bilinear


def no_class(seen):
    pass
