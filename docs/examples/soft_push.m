% A controller in Octave: control.law: process, control.command: octave-cli -q soft_push.m
%
% One JSON line per sample comes in, one goes out; 17 digits hold a number whole.
wanted = 0;
gain = 0.1;
line = fgetl (stdin);
while (ischar (line))
  now = jsondecode (line);
  if (isfield (now, "setup"))  % in the first line, and in one after something has changed
    wanted = now.control.force;
    if (isfield (now.settings, "gain"))
      gain = now.settings.gain;
    end
  end
  volts = 1 + 0.3 * (0.1 - now.encoder) + gain * (wanted - now.force);
  printf ("{\"command\": %.17g, \"calculated_force\": %.17g}\n", volts, now.force);
  fflush (stdout);
  line = fgetl (stdin);
end
