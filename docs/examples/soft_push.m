% A controller in Octave: control.law: process, control.command: octave-cli -q soft_push.m
%
% One JSON line per sample comes in, one goes out; 17 digits hold a number whole. A line is read
% byte by byte, as fgetl waits for the beginning of the next one.
1;  % a script, which may hold functions
function line = read_line ()
  line = "";
  while (! isempty (byte = fread (stdin, 1)) && byte != 10)
    line(end+1) = char (byte);
  end
end

wanted = 0;
gain = 0.1;
while (! isempty (line = read_line ()))
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
end
